#include "vo/wheels/time_span.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(TimeSpans, JoinWhatIsNear) {
  std::vector<TimeSpan> spans;
  add_span(spans, 2 * kSecond, 3 * kSecond);
  add_span(spans, 3 * kSecond, 4 * kSecond);
  add_span(spans, 9 * kSecond, 10 * kSecond);
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_LT(spans[0].first, 2 * kSecond);
  EXPECT_GT(spans[0].second, 4 * kSecond);
  EXPECT_LT(spans[0].second, 5 * kSecond);
}

// A long time may hold a short one that comes later in the list.
TEST(TimeSpans, UniteSetsOfTimes) {
  const std::vector<TimeSpan> a{{0, 10 * kSecond}, {20 * kSecond, 21 * kSecond}};
  const std::vector<TimeSpan> b{{2 * kSecond, 3 * kSecond}, {15 * kSecond, 16 * kSecond}};
  const auto both = united(a, b);
  const std::vector<TimeSpan> expected{
      {0, 10 * kSecond}, {15 * kSecond, 16 * kSecond}, {20 * kSecond, 21 * kSecond}};
  EXPECT_EQ(both, expected);
}

TEST(TimeSpans, LeaveOutWhatIsKnown) {
  const std::vector<TimeSpan> spans{{0, kSecond}, {4 * kSecond, 6 * kSecond}};
  const auto rest = without(spans, {{5 * kSecond, 9 * kSecond}});
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_EQ(rest[0].second, kSecond);
  EXPECT_EQ(without(spans, {}).size(), 2U);
}

}  // namespace
}  // namespace roadbook
