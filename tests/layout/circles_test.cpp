#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

// A pair is a header with its source, named without extension. Pairs that include each other in a
// circle cannot be understood, tested or reused one by one.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

const fs::path kIncludeRoot = ROADBOOK_SOURCE_DIR;

using PairSet = std::set<std::string>;
using IncludeGraph = std::map<std::string, PairSet>;

struct KnownCircle {
  std::string reason;
  PairSet pairs;
};

constexpr const char* kPrivatePart =
    "private part of a class: the header of the sources that implement it";
constexpr const char* kToBeOpened = "not opened yet";

const std::vector<KnownCircle> kKnownCircles = {
    {kPrivatePart, {"base/yaml", "base/yaml_state"}},
    {kPrivatePart, {"vo/odometry_state", "vo/visual_odometry"}},
    {kToBeOpened,
     {"diagnosis/logs/plain_columns", "diagnosis/logs/plain_log", "diagnosis/logs/plain_readings",
      "diagnosis/logs/plain_streams"}},
    {kToBeOpened,
     {"diagnosis/views/hinge_lines", "diagnosis/views/hinge_search", "diagnosis/views/view_fit",
      "diagnosis/views/view_saturation"}},
    {kToBeOpened, {"diagnosis/motion/large_effects", "diagnosis/motion/motion_problem"}},
    {kToBeOpened, {"diagnosis/logs/plain_matrix", "diagnosis/logs/plain_table"}},
    {kToBeOpened, {"diagnosis/views/view_data", "diagnosis/views/view_moments"}},
    {kToBeOpened, {"workflows/diagnosis/diagnosis_run", "workflows/diagnosis/several_drives"}},
};

// "vo/features" of vo/features.hpp and vo/features.cpp.
std::string pair_name(const fs::path& file) { return fs::path(file).replace_extension().string(); }

std::vector<fs::path> module_sources() {
  std::vector<fs::path> files;
  for (const auto& module : fs::directory_iterator(kIncludeRoot)) {
    const std::string name = module.path().filename().string();
    if (name == "tests" || name == "bench" || name == "examples") continue;
    if (!fs::exists(module.path() / "CMakeLists.txt")) continue;
    for (const auto& entry : fs::recursive_directory_iterator(module.path())) {
      const fs::path extension = entry.path().extension();
      if (extension == ".cpp" || extension == ".hpp")
        files.push_back(fs::relative(entry.path(), kIncludeRoot));
    }
  }
  return files;
}

IncludeGraph includes_of_pairs(const std::vector<fs::path>& files) {
  static const std::regex include("#include \"([^\"]+)\"");
  IncludeGraph graph;
  for (const fs::path& file : files) graph[pair_name(file)];
  for (const fs::path& file : files) {
    std::ifstream in(kIncludeRoot / file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it) {
      const std::string target = pair_name((*it)[1].str());
      if (graph.contains(target)) graph[pair_name(file)].insert(target);
    }
  }
  return graph;
}

PairSet reachable_from(const IncludeGraph& graph, const std::string& start) {
  PairSet reached;
  std::vector<std::string> open{start};
  while (!open.empty()) {
    const std::string pair = open.back();
    open.pop_back();
    for (const std::string& next : graph.at(pair))
      if (reached.insert(next).second) open.push_back(next);
  }
  return reached;
}

// The strongly connected components of more than one pair.
std::set<PairSet> circles_of(const IncludeGraph& graph) {
  std::map<std::string, PairSet> reached;
  for (const auto& [pair, targets] : graph) reached[pair] = reachable_from(graph, pair);
  std::set<PairSet> circles;
  for (const auto& [pair, targets] : reached) {
    PairSet circle{pair};
    for (const std::string& other : targets)
      if (reached.at(other).contains(pair)) circle.insert(other);
    if (circle.size() > 1) circles.insert(circle);
  }
  return circles;
}

bool is_subset(const PairSet& part, const PairSet& whole) {
  return std::includes(whole.begin(), whole.end(), part.begin(), part.end());
}

std::string names_in(const PairSet& pairs) {
  std::string names;
  for (const std::string& pair : pairs) names += " " + pair;
  return names;
}

TEST(Circles, PairsIncludeEachOtherOnlyWhereTheListSaysSo) {
  const IncludeGraph graph = includes_of_pairs(module_sources());
  EXPECT_GT(graph.size(), 500U);
  const std::set<PairSet> circles = circles_of(graph);
  for (const PairSet& circle : circles)
    EXPECT_TRUE(std::any_of(kKnownCircles.begin(), kKnownCircles.end(),
                            [&](const auto& known) { return is_subset(circle, known.pairs); }))
        << "a new circle:" << names_in(circle)
        << "\nMove what they share into a header of its own, or the function to the lower file.";
  for (const KnownCircle& known : kKnownCircles)
    EXPECT_TRUE(std::any_of(circles.begin(), circles.end(),
                            [&](const PairSet& circle) { return is_subset(circle, known.pairs); }))
        << "no circle any more, take it off the list:" << names_in(known.pairs);
}

TEST(Circles, SeesACircleAndNoChain) {
  const IncludeGraph graph = {
      {"a", {"b"}}, {"b", {"c"}}, {"c", {"b", "d"}}, {"d", {"d"}}, {"e", {"a"}}};
  EXPECT_EQ(circles_of(graph), std::set<PairSet>{PairSet({"b", "c"})});
  EXPECT_EQ(pair_name("vo/features.hpp"), "vo/features");
}

}  // namespace
}  // namespace roadbook
