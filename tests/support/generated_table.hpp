#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace roadbook::test {

/// Expects that `table` is the text between the lines `<!-- NAME -->` and `<!-- end -->` of a page.
/// With ROADBOOK_WRITE_TABLES=1 in the environment, the page gets this text, and the test fails
/// once.
inline void expect_table_of_page(const std::filesystem::path& file,
                                 const std::string& name,
                                 const std::string& table) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  std::string page = text.str();
  const std::string mark = "<!-- " + name + " -->\n";
  const std::size_t begin = page.find(mark);
  ASSERT_NE(begin, std::string::npos) << file << ": no line " << mark;
  const std::size_t from = begin + mark.size();
  const std::size_t to = page.find("<!-- end -->", from);
  ASSERT_NE(to, std::string::npos) << file << ": no end of " << mark;
  const std::string wanted = "\n" + table + "\n";
  EXPECT_EQ(page.substr(from, to - from), wanted) << file;
  page.replace(from, to - from, wanted);
  if (std::getenv("ROADBOOK_WRITE_TABLES") != nullptr) std::ofstream(file) << page;
}

}  // namespace roadbook::test
