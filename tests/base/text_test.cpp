#include "base/text.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

TEST(Text, NumbersAreReadWholeAndFinite) {
  EXPECT_EQ(parse_double(" 1.5 "), 1.5);
  EXPECT_EQ(parse_double("-2e3"), -2000.0);
  EXPECT_EQ(parse_double("+4"), 4.0);
  for (const char* bad : {"", "nan", "inf", "12abc", "0x10", "1e999", "1,5", "--1"})
    EXPECT_FALSE(parse_double(bad)) << bad;
}

TEST(Text, NanosecondStampsKeepEveryDigit) {
  EXPECT_EQ(parse_int("1403636579763555584"), 1403636579763555584LL);
  EXPECT_FALSE(parse_int("1403636579763555584.0"));
  EXPECT_FALSE(parse_int("99999999999999999999"));
}

TEST(Text, SplitKeepsEmptyFields) {
  EXPECT_EQ(split("a, b,,c").size(), 4U);
  EXPECT_EQ(split("a, b,,c")[1], "b");
  EXPECT_EQ(split("").size(), 1U);
}

TEST(Text, NearestNameForgivesSlipsOnly) {
  const std::vector<std::string> names{"wheel_radius_left", "track_width", "wheelbase"};
  EXPECT_EQ(nearest_name("track_widht", names), "track_width");
  EXPECT_EQ(nearest_name("wheelbse", names), "wheelbase");
  EXPECT_FALSE(nearest_name("colour", names));
}

}  // namespace
}  // namespace roadbook
