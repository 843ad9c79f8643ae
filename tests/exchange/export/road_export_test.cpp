#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "base/text.hpp"
#include "exchange/export/export_map.hpp"
#include "mapping/store/map_file.hpp"
#include "roadnet/paths/path_frame.hpp"
#include "roadnet/routing/lane_layout.hpp"
#include "tests/exchange/driven_place.hpp"
#include "tests/support/command_output.hpp"
#include "tests/support/source_tree.hpp"

// Independent programs read the lanes in other road formats: Python's standard library
// (read_opendrive.py) and xmllint.

namespace roadbook {
namespace {

using test::Folder;
using test::output_of;

std::string reader(const char* script) {
  return "python3 " + (test::source_tree() / "tests/exchange" / script).string() + " ";
}

// Lines by their first word, split at blanks.
std::map<std::string, std::vector<std::vector<std::string>>> lines_of(const std::string& text) {
  std::map<std::string, std::vector<std::vector<std::string>>> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    std::vector<std::string> rest;
    for (std::string word; words >> word;) rest.push_back(word);
    lines[first].push_back(rest);
  }
  return lines;
}

double number(const std::string& text) { return parse_double(text).value(); }

const GeoOrigin kOrigin{47.3769, 8.5417, 30.0};

// A lane as OpenDRIVE has it: a road each way.
struct OneWay {
  const LanePiece* piece = nullptr;
  bool back = false;
  [[nodiscard]] PathPoint at(double s_m) const {
    return piece->curve.at(back ? piece->s_end_m - s_m : piece->s_begin_m + s_m);
  }
};

std::map<std::string, OneWay> ways_by_name(const LaneLayout& layout) {
  std::map<std::string, OneWay> ways;
  for (const LanePiece& piece : layout.pieces) {
    const std::string name = "lane_" + std::to_string(piece.id);
    ways[name] = {&piece, false};
    if (piece.both_ways) ways[name + "_back"] = {&piece, true};
  }
  return ways;
}

// The turns of the layout with names as the reader prints them, both ways where both are driven.
std::multiset<std::pair<std::string, std::string>> turns_of(const LaneLayout& layout) {
  std::multiset<std::pair<std::string, std::string>> turns;
  const auto name = [&](const PieceEnd& end, bool along) {
    return "lane_" + std::to_string(layout.pieces[static_cast<std::size_t>(end.piece)].id) +
           (along ? "" : "_back");
  };
  for (const Connector& c : layout.connectors) {
    turns.emplace(name(c.from, c.from.at_end), name(c.to, !c.to.at_end));
    if (c.both_ways) turns.emplace(name(c.to, c.to.at_end), name(c.from, !c.from.at_end));
  }
  return turns;
}

TEST(RoadExport, OpenDriveIsTheSamePlaceForAReaderOfItsOwn) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  export_map(map, "opendrive", folder / "place.xodr");
  int status = -1;
  const std::string text =
      output_of(reader("read_opendrive.py") + (folder / "place.xodr").string(), &status);
  ASSERT_EQ(status, 0) << text;
  auto lines = lines_of(text);
  EXPECT_TRUE(lines["problem"].empty()) << text.substr(text.find("problem"), 500);
  const test::DrivenPlace place;
  const LaneLayout layout = lay_out(place.network, place.paths);
  ASSERT_GT(layout.connectors.size(), 5U);
  const auto ways = ways_by_name(layout);
  const auto turns = turns_of(layout);
  EXPECT_EQ(lines["road"].size(), ways.size() + turns.size());
  std::size_t compared = 0;
  for (const auto& p : lines["point"]) {
    const auto found = ways.find(p[0]);
    if (found == ways.end()) continue;  // a turn
    const PathPoint at = found->second.at(number(p[1]));
    EXPECT_LT(std::hypot(number(p[2]) - at.position.x(), number(p[3]) - at.position.y()), 0.01);
    EXPECT_NEAR(number(p[4]), at.height_m, 0.01);
    ++compared;
  }
  EXPECT_GT(compared, 400U);
  std::multiset<std::pair<std::string, std::string>> written;
  for (const auto& t : lines["turn"]) written.emplace(t[0], t[1]);
  EXPECT_EQ(written, turns);
  EXPECT_EQ(lines["georeference"].at(0).at(0), "none");
  EXPECT_EQ(output_of("xmllint --noout " + (folder / "place.xodr").string()), "");
}

TEST(RoadExport, OpenDriveWithAnOriginIsTurnedToEastAndNorth) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  ExportOptions options;
  options.origin = kOrigin;
  export_map(map, "opendrive", folder / "place.xodr", options);
  auto lines = lines_of(output_of(reader("read_opendrive.py") + (folder / "place.xodr").string()));
  EXPECT_TRUE(lines["problem"].empty());
  EXPECT_EQ(lines["georeference"].at(0).at(0), "+proj=aeqd");
  const test::DrivenPlace place;
  const LaneLayout layout = lay_out(place.network, place.paths);
  const auto ways = ways_by_name(layout);
  const Eigen::Rotation2Dd turn(kOrigin.x_axis_deg * std::numbers::pi / 180.0);
  for (const auto& p : lines["point"]) {
    const auto found = ways.find(p[0]);
    if (found == ways.end()) continue;
    const Eigen::Vector2d expected = turn * found->second.at(number(p[1])).position;
    EXPECT_LT((Eigen::Vector2d(number(p[2]), number(p[3])) - expected).norm(), 0.01);
  }
}

// Python reads, and integrates heading and curvature to get positions and headings again.
}  // namespace
}  // namespace roadbook
