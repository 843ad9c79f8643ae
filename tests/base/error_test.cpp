#include "base/error.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

TEST(Error, LineNamesPlaceFieldFoundAndExpected) {
  const Problem all{Severity::kError, "cam0/data.csv", 12, "timestamp", "12 s", "nanoseconds"};
  EXPECT_EQ(to_line(all), "error: cam0/data.csv:12: timestamp: got 12 s, want nanoseconds");
}

TEST(Error, LineLeavesOutWhatDoesNotApply) {
  EXPECT_EQ(to_line({Severity::kWarning, "cam0/data.csv", 0, "", "3 missing images", ""}),
            "warning: cam0/data.csv: got 3 missing images");
}

TEST(Error, BadInputSpeaksOfTheFirstErrorNotOfAWarning) {
  const BadInput bad(
      {{Severity::kWarning, "a", 0, "", "x", ""}, {Severity::kError, "b", 0, "", "y", "z"}});
  EXPECT_STREQ(bad.what(), "error: b: got y, want z");
  EXPECT_EQ(bad.status(), ExitStatus::kBadInput);
  EXPECT_EQ(bad.problems().size(), 2U);
}

}  // namespace
}  // namespace roadbook
