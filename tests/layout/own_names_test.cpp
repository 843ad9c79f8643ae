#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/layout/declared_names.hpp"

// Builds without a compiler cache compile some files of a folder together
// (cmake/quick_build.cmake), and small folders of a target with each other. The selection changes
// with every new file. So names that a file declares for itself must be unique among the files of
// its folder in its target, in small folders among those of all small folders. Compilers report a
// clash only for files that are compiled together.

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::declared_names;
using test::DeclaredNames;

using NamesOfFiles = std::map<std::string, DeclaredNames>;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// What cannot be compiled together, one line each: own names that are declared in another file as
// well, in a function of another file, or in a header that one of the files includes.
std::vector<std::string> clashes(const NamesOfFiles& files, const NamesOfFiles& headers) {
  std::map<std::string, std::pair<std::string, std::string>> known;  // name -> file, text
  std::vector<std::string> found;
  const auto say = [&](const std::string& name, const std::string& a, const std::string& b) {
    found.push_back(name + ": " + a + " and " + b);
  };
  for (const auto& [file, names] : files)
    for (const auto& [name, text] : names.own) {
      const auto [first, fresh] = known.try_emplace(name, file, text);
      if (!fresh && (text.empty() || text != first->second.second))
        say(name, first->second.first, file);
      for (const auto& [header, of] : headers)
        if (!text.starts_with("using ") && of.shared.contains(name)) say(name, file, header);
    }
  for (const auto& [name, own] : known)
    for (const auto& [file, names] : files)
      if (file != own.first && names.local.contains(name.substr(name.rfind(' ') + 1)))
        say(name, own.first, "a function of " + file);
  return found;
}

using Texts = std::map<std::string, std::string>;

NamesOfFiles names_of(const Texts& texts) {
  NamesOfFiles names;
  for (const auto& [file, text] : texts)
    names[file] = declared_names("namespace roadbook {\n" + text + "\n}  // namespace roadbook\n");
  return names;
}

std::vector<std::string> clashes_of(const std::string& a,
                                    const std::string& b,
                                    const Texts& headers = {}) {
  return clashes(names_of({{"a.cpp", "namespace {\n" + a + "\n}"}, {"b.cpp", b}}),
                 names_of(headers));
}

std::string own(const std::string& text) { return "namespace {\n" + text + "\n}"; }

TEST(Layout, SeesWhatTwoFilesCallTheSame) {
  using Lines = std::vector<std::string>;
  const auto clash = [](const char* name) {
    return Lines{"roadbook " + std::string(name) + ": a.cpp and b.cpp"};
  };
  EXPECT_EQ(clashes_of("constexpr double kStep = 1.0;", own("constexpr int kStep{2};")),
            clash("kStep"));
  EXPECT_EQ(
      clashes_of("const std::map<int, char> kOf = {{1, 'a'}};", own("const int kOf[] = {1};")),
      clash("kOf"));
  EXPECT_EQ(clashes_of("constexpr int kA = 1, kB = kA;", own("constexpr int kB = 3;")),
            clash("kB"));
  // Whatever they take: which one a call means would depend on the batch.
  EXPECT_EQ(
      clashes_of("int f(const std::map<int, int>& m = {}) { return m.at(1); }",
                 own("template <typename T>\n[[nodiscard]] std::vector<T> f(T t) { return {t}; }")),
      clash("f"));
  EXPECT_EQ(clashes_of("struct A final : B { int x; };", own("enum class A { kOne };")),
            clash("A"));
  EXPECT_EQ(clashes_of("using Json = nlohmann::json;", own("using Json = nlohmann::ordered_json;")),
            clash("Json"));
  EXPECT_EQ(clashes_of("constexpr int kN = 1;", "void f() {\n  constexpr int kN = 2;\n}"),
            Lines{"roadbook kN: a.cpp and a function of b.cpp"});
  EXPECT_EQ(clashes_of("constexpr int kN = 1;", "struct A {\n  int f() { const int kN = 2; }\n};"),
            Lines{"roadbook kN: a.cpp and a function of b.cpp"});
  EXPECT_EQ(clashes_of("struct Pose {};", "", {{"p.hpp", "class Pose {};"}}),
            Lines{"roadbook Pose: a.cpp and p.hpp"});
}

TEST(Layout, LeavesToFilesWhatDoesNoHarm) {
  const std::vector<std::string> none;
  EXPECT_EQ(clashes_of("using Json = nlohmann::json;", own("using Json = nlohmann::json;")), none);
  EXPECT_EQ(clashes_of("using std::max;", own("using std::max;")), none);
  // Members, parameters, what a comment or a string says.
  EXPECT_EQ(clashes_of("struct A { int f(); };\nint A::f() { return 1; }",
                       own("struct B { int f(); };\nint B::f() { return 1; }")),
            none);
  EXPECT_EQ(clashes_of("// int f();\nconst char* kA = R\"(int f() {})\";", own("int f(int kA);")),
            none);
  EXPECT_EQ(clashes_of("#define F(x) \\\n  int g(x)\nint f(int g) { return g; }",
                       own("int g() { return 1'000; }")),
            none);
  EXPECT_EQ(clashes_of("TEST(A, B) { int x = 1; }", own("TEST(A, C) { int x = 1; }")), none);
  EXPECT_EQ(clashes_of("bool operator<(A a, A b);", own("bool operator<(B a, B b);")), none);
  // A name of another namespace, and a function with other parameters.
  EXPECT_EQ(clashes_of("struct Pose {};\nint size(Pose p);", "",
                       {{"p.hpp", "namespace sim {\nclass Pose {};\n}\nint size(int);\n"}}),
            none);
  EXPECT_EQ(clashes_of("constexpr int kN = 1;", "int f() {\n  return g(kN, {kN});\n}"), none);
  EXPECT_EQ(clashes_of("constexpr int kN = 1;", "struct A {\n  static constexpr int kN = 2;\n};"),
            none);
}

// ROADBOOK_UNITY_SMALL of cmake/quick_build.cmake.
constexpr std::size_t kFilesOfASmallFolder = 8;

// The folders of the targets that a CMake file names: a list of sources for each target and folder,
// one for all small folders of a target.
std::vector<std::vector<fs::path>> folders_of_targets_in(const fs::path& cmake_file) {
  static const std::regex comment("#[^\n]*");
  static const std::regex call(R"(\(([^()]*\.cpp[^()]*)\))");
  const std::string text = std::regex_replace(text_of(cmake_file), comment, "");
  std::vector<std::vector<fs::path>> lists;
  for (std::sregex_iterator m(text.begin(), text.end(), call), end; m != end; ++m) {
    std::istringstream words((*m)[1]);
    std::map<fs::path, std::vector<fs::path>> folders;
    for (std::string word; words >> word;)
      if (const fs::path file = (cmake_file.parent_path() / word).lexically_normal();
          word.ends_with(".cpp") && fs::exists(file))
        folders[file.parent_path()].push_back(file);
    std::vector<fs::path> of_small;
    for (auto& [folder, sources] : folders)
      if (sources.size() > kFilesOfASmallFolder)
        lists.push_back(std::move(sources));
      else
        of_small.insert(of_small.end(), sources.begin(), sources.end());
    if (!of_small.empty()) lists.push_back(std::move(of_small));
  }
  return lists;
}

// Files of the project, each read once.
class Project {
 public:
  explicit Project(fs::path root) : root_(std::move(root)) {}

  const DeclaredNames& names(const fs::path& file) {
    const auto known = names_.find(file);
    return known != names_.end()
               ? known->second
               : names_.try_emplace(file, declared_names(text_of(file))).first->second;
  }

  // Adds the headers that the file includes, and what those include.
  void add_headers(const fs::path& file, std::set<fs::path>& headers) {
    for (const fs::path& header : included(file))
      if (headers.insert(header).second) add_headers(header, headers);
  }

  [[nodiscard]] std::string short_name(const fs::path& file) const {
    return file.lexically_relative(root_).string();
  }

 private:
  const std::vector<fs::path>& included(const fs::path& file) {
    const auto [known, fresh] = included_.try_emplace(file);
    if (!fresh) return known->second;
    std::istringstream lines(text_of(file));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("#include \""))
        if (const fs::path header = root_ / line.substr(10, line.rfind('"') - 10);
            fs::exists(header))
          known->second.push_back(header);
    return known->second;
  }

  fs::path root_;
  std::map<fs::path, DeclaredNames> names_;
  std::map<fs::path, std::vector<fs::path>> included_;
};

std::vector<fs::path> cmake_files_of(const fs::path& root) {
  std::vector<fs::path> files;
  for (const auto& top : fs::directory_iterator(root)) {
    if (!top.is_directory() || !fs::exists(top.path() / "CMakeLists.txt")) continue;
    for (const auto& entry : fs::recursive_directory_iterator(top))
      if (entry.path().filename() == "CMakeLists.txt") files.push_back(entry.path());
  }
  return files;
}

TEST(Layout, NoTwoFilesOfAFolderHaveOwnNamesInCommon) {
  const fs::path root = ROADBOOK_SOURCE_DIR;
  Project project(root);
  std::size_t files_read = 0;
  for (const fs::path& cmake_file : cmake_files_of(root))
    for (const std::vector<fs::path>& sources : folders_of_targets_in(cmake_file)) {
      NamesOfFiles files, headers;
      std::set<fs::path> included;
      for (const fs::path& file : sources) {
        files[project.short_name(file)] = project.names(file);
        project.add_headers(file, included);
      }
      for (const fs::path& header : included)
        headers[project.short_name(header)] = project.names(header);
      for (const std::string& clash : clashes(files, headers)) ADD_FAILURE() << clash;
      files_read += files.size();
    }
  EXPECT_GT(files_read, 500u);
}

}  // namespace
}  // namespace roadbook
