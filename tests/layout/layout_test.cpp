#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// The rules of docs/design that a compiler does not check.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = ROADBOOK_SOURCE_DIR;

// Folders that each folder may include (the table of docs/design/architecture.md).
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"base", {}},
    {"sensors", {"base"}},
    {"drive", {"base", "sensors"}},
    {"vo", {"base", "sensors", "drive"}},
    {"mapping", {"base", "sensors", "drive", "vo"}},
    {"semantics", {"base", "sensors", "drive", "vo", "mapping"}},
    {"roadnet", {"base"}},
    {"speedmap", {"base", "sensors", "roadnet"}},
    {"diagnosis", {"base", "sensors", "drive", "vo", "mapping", "roadnet", "speedmap"}},
    {"exchange", {"base", "sensors", "drive", "vo", "mapping", "semantics", "roadnet", "speedmap"}},
    {"sim", {"base", "sensors", "drive", "roadnet"}},
    {"workflows",
     {"base", "sensors", "drive", "vo", "mapping", "semantics", "roadnet", "speedmap", "diagnosis",
      "exchange", "sim"}},
    {"apps",
     {"base", "sensors", "drive", "vo", "mapping", "semantics", "roadnet", "speedmap", "diagnosis",
      "exchange", "sim", "workflows"}},
};

bool is_source(const fs::path& file) {
  return file.extension() == ".cpp" || file.extension() == ".hpp";
}

std::vector<fs::path> sources_in(const std::string& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(kRoot / folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
    if (entry.is_regular_file() && is_source(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// First parts of the paths a file includes in quotes, of those that are folders of the project.
std::set<std::string> folders_included(const std::string& text) {
  static const std::regex include(R"(^\s*#\s*include\s*[<"]([a-z_]+)/)");
  std::set<std::string> folders;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (std::smatch match; std::regex_search(line, match, include))
      if (kMayInclude.contains(match[1])) folders.insert(match[1]);
  return folders;
}

TEST(Layout, IncludesGoOnlyDownwards) {
  for (const auto& [folder, allowed] : kMayInclude)
    for (const fs::path& file : sources_in(folder))
      for (const std::string& included : folders_included(content_of(file)))
        EXPECT_TRUE(included == folder || allowed.contains(included))
            << fs::relative(file, kRoot) << " includes \"" << included << "/...\"";
}

// A newcomer reads the list of a folder at a glance.
TEST(Layout, NoFolderHoldsMoreThan25PairsOfSourceAndHeader) {
  std::map<fs::path, std::set<std::string>> pairs;
  for (const auto& [folder, allowed] : kMayInclude)
    for (const fs::path& file : sources_in(folder))
      pairs[file.parent_path()].insert(file.stem().string());
  for (const auto& [folder, stems] : pairs)
    EXPECT_LE(stems.size(), 25u) << fs::relative(folder, kRoot);
  EXPECT_GT(pairs.size(), 40u);
}

// What a verb does is a function of workflows/; the verb declares options, calls it, prints.
TEST(Layout, VerbsAreShort) {
  for (const auto& entry : fs::directory_iterator(kRoot / "apps" / "verbs")) {
    const std::string text = content_of(entry.path());
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 100) << entry.path();
  }
}

TEST(Layout, LibrariesDoNotPrint) {
  static const std::regex prints(R"(std::(cout|cerr)|\bprintf\(|#\s*include\s*<(CLI|spdlog)/)");
  for (const auto& [folder, allowed] : kMayInclude)
    for (const fs::path& file : sources_in(folder))
      if (folder != "apps") {
        EXPECT_FALSE(std::regex_search(content_of(file), prints)) << fs::relative(file, kRoot);
      }
}

TEST(Layout, NoFolderIsForgotten) {
  for (const auto& entry : fs::directory_iterator(kRoot)) {
    const std::string folder = entry.path().filename().string();
    if (!entry.is_directory() || folder == "tests" || folder == "bench" || folder == "build")
      continue;
    if (fs::exists(entry.path() / "CMakeLists.txt")) {
      EXPECT_TRUE(kMayInclude.contains(folder)) << folder;
    }
  }
}

TEST(Layout, SeesAnIncludeThatGoesUp) {
  EXPECT_EQ(
      folders_included("#include \"mapping/map.hpp\"\n# include <vo/x.hpp>\n#include <vector>"),
      (std::set<std::string>{"mapping", "vo"}));
  EXPECT_FALSE(kMayInclude.at("base").contains("mapping"));
}

// Nor does what ships rest on what tests: injectors of effects are theirs alone.
TEST(Layout, NothingIncludesTests) {
  static const std::regex include(R"(#\s*include\s*[<"]tests/)");
  for (const auto& [folder, allowed] : kMayInclude)
    for (const fs::path& file : sources_in(folder))
      EXPECT_FALSE(std::regex_search(content_of(file), include)) << fs::relative(file, kRoot);
}

// Who finds causes must not be able to look where they were hidden.
TEST(Layout, DiagnosisNeverReadsTheTruth) {
  for (const fs::path& file : sources_in("diagnosis")) {
    const std::string text = content_of(file);
    EXPECT_EQ(text.find("true_poses"), std::string::npos) << file;
    EXPECT_EQ(text.find("\"truth\""), std::string::npos) << file;
  }
}

// Types that a header defines outside of other types.
std::set<std::string> types_defined(const std::string& text) {
  static const std::regex definition(
      R"(^(struct|class|enum class) ([A-Za-z_]\w*)\b(?!::)[^;(]*\{)");
  std::set<std::string> types;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (std::smatch match; std::regex_search(line, match, definition)) types.insert(match[2]);
  return types;
}

// All stand in one namespace: a second type of the same name is undefined behaviour that no linker
// reports.
TEST(Layout, NoTwoHeadersDefineTypesOfTheSameName) {
  std::map<std::string, fs::path> defined;
  for (const auto& [folder, allowed] : kMayInclude)
    for (const fs::path& file : sources_in(folder)) {
      if (file.extension() != ".hpp") continue;
      for (const std::string& type : types_defined(content_of(file))) {
        const auto [first, fresh] = defined.try_emplace(type, file);
        EXPECT_TRUE(fresh) << type << " in " << file << " and " << first->second;
      }
    }
}

TEST(Layout, SeesTypesAndNoDeclarations) {
  EXPECT_EQ(types_defined("struct Map;\nclass A final : public B {\nenum class C { kOne };\n"
                          "  struct Inner {\nstruct D {\nstruct Map::State {"),
            (std::set<std::string>{"A", "C", "D"}));
}

TEST(Layout, EveryHeaderIsGuarded) {
  for (const auto& [folder, allowed] : kMayInclude)
    for (const fs::path& file : sources_in(folder))
      if (file.extension() == ".hpp") {
        EXPECT_NE(content_of(file).find("#pragma once"), std::string::npos) << file;
      }
}

TEST(Layout, SourcesAreFormatted) {
  if (std::system("clang-format --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "clang-format is not installed";
  std::vector<std::string> folders{"tests", "bench"};
  for (const auto& [folder, allowed] : kMayInclude) folders.push_back(folder);
  for (const std::string& folder : folders) {
    // Linux takes at most 128 KiB in one command, so that long paths of a clone must not count.
    std::string command = "cd '" + kRoot.string() + "' && clang-format --dry-run --Werror";
    for (const fs::path& file : sources_in(folder))
      command += " '" + fs::relative(file, kRoot).string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << "run clang-format -i on the files named above";
  }
}

}  // namespace
}  // namespace roadbook
