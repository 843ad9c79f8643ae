#include "base/utf8.hpp"

#include <gtest/gtest.h>

#include <string>

namespace roadbook {
namespace {

TEST(Utf8, CountsCharactersNotBytes) {
  EXPECT_EQ(utf8_characters(""), 0U);
  EXPECT_EQ(utf8_characters("plain"), 5U);
  EXPECT_EQ(utf8_characters("Zürich"), 6U);
  EXPECT_EQ(utf8_characters("€\U0001F697\U0010FFFF"), 3U);
}

// The first and the last character of each length, and those beside the surrogates.
TEST(Utf8, TakesAllThatThereIs) {
  for (const std::string& bytes : std::vector<std::string>{
           "\x01", "\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xEF\xBF\xBF", "\xED\x9F\xBF",
           "\xEE\x80\x80", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    EXPECT_EQ(utf8_characters(bytes), 1U) << bytes;
  EXPECT_EQ(utf8_characters(std::string_view("\0a", 2)), 2U);
}

// The ill-formed sequences of RFC 3629 and the Unicode standard's table 3-7.
TEST(Utf8, KnowsWhatIsNone) {
  for (const std::string& bytes : std::vector<std::string>{
           "\xFC", "a\x80", "\xC3", "\xC3(", "\xE2\x82", "\xC0\xAF", "\xC1\xBF", "\xE0\x9F\xBF",
           "\xED\xA0\x80", "\xED\xBF\xBF",
           "\xE2\x82"
           "a",
           "\xF0\x9F\x9A", "\xF0\x9F\x9A(", "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80",
           "\xF5\x80\x80\x80", "\xF8\x88\x80\x80\x80", "\x80", "\xFF"})
    EXPECT_FALSE(utf8_characters(bytes)) << bytes;
}

}  // namespace
}  // namespace roadbook
