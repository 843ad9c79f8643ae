#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "apps/label_server/label_api.hpp"
#include "tests/support/source_tree.hpp"

// The reference of the HTTP interface lists the routes of the server, each once.

namespace roadbook {
namespace {

using Names = std::multiset<std::string>;

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// Requests in the first column of the tables: `METHOD /path` in backticks.
Names documented() {
  Names names;
  const std::string text = text_of(test::source_tree() / "docs" / "reference" / "http_api.md");
  const std::regex row("\n\\| `(GET|POST|PUT|DELETE) (/[^`]*)` \\|");
  for (auto it = std::sregex_iterator(text.begin(), text.end(), row); it != std::sregex_iterator();
       ++it)
    names.insert((*it)[1].str() + " " + (*it)[2].str());
  return names;
}

TEST(LabelRoutes, AreThoseOfTheReference) {
  Names served;
  for (const LabelApi::Route& route : LabelApi::routes())
    served.insert(route.method + " " + route.path);
  EXPECT_GT(served.size(), 20U);
  EXPECT_EQ(documented(), served);
}

// The first match answers, so that no pattern may hide a later route.
TEST(LabelRoutes, NoTwoAnswerTheSameRequest) {
  std::set<std::string> shapes;
  const std::regex value("/[A-Z][A-Z_]*");
  for (const LabelApi::Route& route : LabelApi::routes())
    EXPECT_TRUE(
        shapes.insert(route.method + " " + std::regex_replace(route.path, value, "/*")).second)
        << route.method << " " << route.path;
}

// The page asks for nothing that the server does not have.
TEST(LabelRoutes, HaveEveryAddressThatThePageUses) {
  std::set<std::string> begins;
  for (const LabelApi::Route& route : LabelApi::routes())
    begins.insert(route.path.substr(0, route.path.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ")));
  std::size_t found = 0;
  const std::regex address("['`](api/[a-z/]*)");
  const auto sources = test::source_tree() / "apps" / "label_ui" / "src";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(sources)) {
    if (entry.path().extension() != ".ts") continue;
    const std::string text = text_of(entry.path());
    for (auto it = std::sregex_iterator(text.begin(), text.end(), address);
         it != std::sregex_iterator(); ++it, ++found)
      EXPECT_TRUE(begins.contains("/" + (*it)[1].str())) << entry.path() << ": " << (*it)[1];
  }
  EXPECT_GT(found, 15U);
}

}  // namespace
}  // namespace roadbook
