#include "base/parallel.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace roadbook {
namespace {

TEST(Parallel, VisitsEveryItemOnceOnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 5}) {
    std::vector<int> visits(1000);
    parallel_for(visits.size(), threads, [&](std::size_t i) { ++visits[i]; });
    EXPECT_EQ(visits, std::vector<int>(1000, 1));
  }
}

TEST(Parallel, VisitsEverySmallItemOnceOnAnyNumberOfThreads) {
  for (const std::size_t count : {0U, 1U, 256U, 1000U})
    for (const int threads : {1, 2, 5}) {
      std::vector<int> visits(count);
      parallel_for_small(count, threads, [&](std::size_t i) { ++visits[i]; });
      EXPECT_EQ(visits, std::vector<int>(count, 1));
    }
}

TEST(Parallel, ThrowsTheExceptionOfTheFirstItemThatFailed) {
  try {
    parallel_for(100, 2, [](std::size_t i) {
      if (i >= 10) throw std::runtime_error(std::to_string(i));
    });
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "10");
  }
}

}  // namespace
}  // namespace roadbook
