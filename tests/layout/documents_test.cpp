#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

// Rules for pages of documentation: links lead somewhere, pages and tables stay short.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

const fs::path kProject = ROADBOOK_SOURCE_DIR;
constexpr std::size_t kMostLinesOfAGuide = 150;
constexpr int kMostColumns = 6;

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<fs::path> pages() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(kProject / "docs"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  for (const char* page : {"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "bench/README.md"})
    found.push_back(kProject / page);
  std::sort(found.begin(), found.end());
  return found;
}

// Targets of the links of a line; those to other sites are left out.
std::vector<std::string> links_in(const std::string& line) {
  std::vector<std::string> links;
  for (std::size_t at = line.find("]("); at != std::string::npos; at = line.find("](", at + 1)) {
    const std::string link = line.substr(at + 2, line.find(')', at) - at - 2);
    if (link.find("://") == std::string::npos) links.push_back(link);
  }
  return links;
}

// The anchor that web pages of repositories give a heading.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading.substr(heading.find_first_not_of("# "))) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0 || c == '_' || c == '-' || u >= 0x80)
      anchor += static_cast<char>(std::tolower(u));
    else if (c == ' ')
      anchor += '-';
  }
  return anchor;
}

std::set<std::string> anchors_of(const fs::path& page) {
  std::set<std::string> anchors;
  bool code = false;
  for (const std::string& line : lines_of(page)) {
    if (line.starts_with("```")) code = !code;
    if (!code && line.starts_with("#")) anchors.insert(anchor_of(line));
  }
  return anchors;
}

int columns_of(const std::string& row) {
  int bars = 0;
  bool code = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] == '`') code = !code;
    if (row[i] == '|' && !code && (i == 0 || row[i - 1] != '\\')) ++bars;
  }
  return bars - 1;
}

TEST(Documents, LinksLeadToPagesAndTheirHeadings) {
  for (const fs::path& page : pages())
    for (const std::string& line : lines_of(page))
      for (const std::string& link : links_in(line)) {
        const std::size_t hash = link.find('#');
        const std::string file = link.substr(0, hash);
        const fs::path target = file.empty() ? page : page.parent_path() / file;
        ASSERT_TRUE(fs::exists(target)) << fs::relative(page, kProject) << ": " << link;
        if (hash != std::string::npos && target.extension() == ".md") {
          EXPECT_TRUE(anchors_of(target).contains(link.substr(hash + 1)))
              << fs::relative(page, kProject) << ": " << link;
        }
      }
}

TEST(Documents, GuidesAreShortAndTablesNarrow) {
  for (const fs::path& page : pages()) {
    const std::vector<std::string> lines = lines_of(page);
    const std::string name = fs::relative(page, kProject).string();
    if (page.parent_path().filename() == "guide") {
      EXPECT_LE(lines.size(), kMostLinesOfAGuide) << name;
    }
    for (const std::string& line : lines)
      if (line.starts_with("|")) {
        EXPECT_LE(columns_of(line), kMostColumns) << name << ": " << line;
      }
  }
}

bool is_rule(const std::string& row) {
  return row.starts_with("|-") && row.find_first_not_of("|-: ") == std::string::npos;
}

// A table with a rule in place of a row still looks like a table.
TEST(Documents, TablesHaveOneRuleAndEqualRows) {
  for (const fs::path& page : pages()) {
    std::vector<std::string> table;
    std::vector<std::string> lines = lines_of(page);
    lines.emplace_back();
    for (const std::string& line : lines) {
      if (line.starts_with("|")) {
        table.push_back(line);
        continue;
      }
      const std::string name = fs::relative(page, kProject).string();
      for (std::size_t i = 0; i < table.size(); ++i) {
        EXPECT_EQ(is_rule(table[i]), i == 1) << name << ": " << table[i];
        EXPECT_EQ(columns_of(table[i]), columns_of(table.front())) << name << ": " << table[i];
      }
      table.clear();
    }
  }
}

std::string lines_joined(const fs::path& file) {
  std::string text;
  for (const std::string& line : lines_of(file)) text += line + "\n";
  return text;
}

// Words of letters, digits and underscores between two characters `quote`.
std::set<std::string> words_between(const std::string& text, char quote) {
  std::set<std::string> words;
  std::string word;
  bool inside = false;
  for (const char c : text) {
    const bool part = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    if (inside && part) word += c;
    if (!part && !word.empty()) words.insert(std::exchange(word, {}));
    if (c == quote) inside = !inside;
  }
  return words;
}

// The parser lists the keys of each mapping as `only({"key", ...})`.
TEST(Documents, TheScenarioReferenceHasEveryKeyOfTheParser) {
  const std::string parser = lines_joined(kProject / "sim" / "scenario" / "scenario_parser.cpp");
  const auto documented =
      words_between(lines_joined(kProject / "docs" / "reference" / "simulation.md"), '`');
  std::size_t keys = 0;
  for (std::size_t at = parser.find("only({"); at != std::string::npos;
       at = parser.find("only({", at + 1)) {
    const std::string list = parser.substr(at, parser.find("})", at) - at);
    for (const std::string& key : words_between(list, '"')) {
      EXPECT_TRUE(documented.contains(key)) << key;
      ++keys;
    }
  }
  EXPECT_GT(keys, 70U);
}

TEST(Documents, SourcesNamePagesThatExist) {
  for (const char* folder : {"base", "sensors", "drive", "vo", "mapping", "semantics", "roadnet",
                             "speedmap", "diagnosis", "exchange", "sim", "workflows", "apps"})
    for (const auto& entry : fs::recursive_directory_iterator(kProject / folder)) {
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      for (const std::string& line : lines_of(entry.path()))
        for (std::size_t at = line.find("docs/"); at != std::string::npos;
             at = line.find("docs/", at + 1)) {
          const std::size_t end = line.find(".md", at);
          if (end == std::string::npos) continue;
          const std::string page = line.substr(at, end + 3 - at);
          EXPECT_TRUE(page.find(' ') != std::string::npos || fs::exists(kProject / page))
              << fs::relative(entry.path(), kProject) << ": " << page;
        }
    }
}

TEST(Documents, HeadingsHaveTheAnchorsOfRepositoryPages) {
  EXPECT_EQ(anchor_of("## vehicle.yaml"), "vehicleyaml");
  EXPECT_EQ(anchor_of("### Rows that straighten: a map"), "rows-that-straighten-a-map");
  EXPECT_EQ(columns_of("| a | `b|c` | d\\|e |"), 3);
}

}  // namespace
}  // namespace roadbook
