#pragma once

#include <gtest/gtest.h>

#include <string>

namespace roadbook::test {

inline void expect_words(const std::string& message, const std::string& words) {
  EXPECT_NE(message.find(words), std::string::npos) << message;
}

}  // namespace roadbook::test
