#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "exchange/export/export_map.hpp"
#include "roadnet/routing/lane_layout.hpp"
#include "tests/exchange/checker_lines.hpp"
#include "tests/exchange/sumo_places.hpp"
#include "tests/support/command_output.hpp"
#include "tests/support/source_tree.hpp"

// SUMO itself checks the OpenDRIVE files: check_sumo.py runs netconvert and sumo. It compares their
// results with tables that do not come from the writer.

namespace roadbook {
namespace {

using test::count_noted;
using test::DrivenPlace;
using test::Folder;
using test::output_of;
using test::sumo_lines;
using test::SumoLines;

bool sumo_is_missing() {
  int status = -1;
  (void)output_of("command -v netconvert && command -v sumo", &status);
  return status != 0;
}

#define NEED_SUMO() \
  if (sumo_is_missing()) GTEST_SKIP() << "netconvert and sumo not found (Debian package sumo)"

std::vector<double> numbers_of(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream in(line);
  for (double value = 0.0; in >> value;) numbers.push_back(value);
  return numbers;
}

void write_expected(const std::filesystem::path& file, const std::vector<test::Outline>& outlines) {
  nlohmann::json list = nlohmann::json::array();
  for (const test::Outline& outline : outlines) {
    nlohmann::json corners = nlohmann::json::array();
    for (const Eigen::Vector2d& p : outline.corners) corners.push_back({p.x(), p.y()});
    list.push_back({{"type", outline.layer == "crossings" ? "crosswalk" : "parkingSpace"},
                    {"corners", corners}});
  }
  std::ofstream(file) << list;
}

struct SumoCase {
  std::vector<test::Outline> outlines{};
  bool speeds = true;
  std::optional<GeoOrigin> origin{};
  double crawl = INFINITY;
};

// Returns the results of SUMO for the file of a place.
SumoLines judged_by_sumo(const DrivenPlace& place,
                         const SumoCase& how,
                         ExportNotes* notes = nullptr) {
  const Folder folder;
  const auto map = test::sumo_map(folder, place, how.outlines, how.speeds, how.crawl);
  ExportOptions options;
  options.origin = how.origin;
  export_map(map, "opendrive", folder / "place.xodr", options, notes);
  ExportOptions table;
  table.step_m = 0.1;
  export_map(map, "path", folder / "path.csv", table);
  write_expected(folder / "outlines.json", how.outlines);
  std::string command =
      "python3 " + (test::source_tree() / "tests/exchange/check_sumo.py").string() + " " +
      (folder / "place.xodr").string() + " " + (folder / "path.csv").string() + " " +
      (folder / "").string() + " --outlines " + (folder / "outlines.json").string();
  if (how.origin)
    command += " --turn-deg " + std::to_string(how.origin->x_axis_deg) + " --origin " +
               std::to_string(how.origin->latitude_deg) + " " +
               std::to_string(how.origin->longitude_deg);
  int status = -1;
  const std::string text = output_of(command, &status);
  EXPECT_EQ(status, 0) << text;
  auto lines = sumo_lines(text);
  for (const std::string& line : lines["problem"]) ADD_FAILURE() << line;
  EXPECT_EQ(lines["drive"].size(), 2U) << text;
  return lines;
}

// Returns the turns of the map with the names of the checker. A turn that is driven both ways has
// both directions.
std::multiset<std::string> expected_turns(const DrivenPlace& place) {
  const LaneLayout layout = lay_out(place.network, place.paths);
  std::multiset<std::string> turns;
  const auto name = [&](const PieceEnd& end, bool along) {
    const LanePiece& piece = layout.pieces[static_cast<std::size_t>(end.piece)];
    return std::to_string(piece.id) + (along != piece.turned ? " forward" : " backward");
  };
  for (const Connector& c : layout.connectors) {
    turns.insert(name(c.from, c.from.at_end) + " " + name(c.to, !c.to.at_end));
    if (c.both_ways) turns.insert(name(c.to, c.to.at_end) + " " + name(c.from, !c.from.at_end));
  }
  return turns;
}

std::multiset<std::string> set_of(const std::vector<std::string>& lines) {
  return {lines.begin(), lines.end()};
}

// Each lane has the driven directions, the turns are those of the map, and every vehicle arrives.
void expect_driven(SumoLines& lines, const DrivenPlace& place) {
  EXPECT_EQ(set_of(lines["turn"]), expected_turns(place));
  std::multiset<std::string> ways;
  for (const std::string& line : lines["road"]) ways.insert(line.substr(line.find(' ') + 1));
  std::set<std::string> once(ways.begin(), ways.end());
  std::set<std::string> expected;
  for (const Lane& lane : place.network.lanes) {
    if (lane.forward_passes > 0) expected.insert(std::to_string(lane.id) + " forward");
    if (lane.backward_passes > 0) expected.insert(std::to_string(lane.id) + " backward");
  }
  EXPECT_EQ(once, expected);
  for (const std::string& line : lines["drive"]) {
    const auto n = numbers_of(line);
    ASSERT_EQ(n.size(), 7U) << line;
    EXPECT_EQ(n[0], n[1]) << "vehicles that did not arrive";
    EXPECT_EQ(n[2], 0.0) << "teleports";
    EXPECT_EQ(n[3], 0.0) << "collisions";
    EXPECT_LE(n[4], 0.3) << "m/s above the map";
  }
}

TEST(OpenDriveSumo, DrivesEveryLaneAndTurnNoFasterThanTheMapAndFindsAllOutlines) {
  NEED_SUMO();
  const DrivenPlace place;
  const auto outlines = test::outlines_along(place.paths);
  ASSERT_GT(outlines.size(), 60U);
  auto lines = judged_by_sumo(place, {outlines});
  expect_driven(lines, place);
  EXPECT_GT(lines["turn"].size(), 10U);
  EXPECT_LE(numbers_of(lines["shape"].at(0))[0], 0.01);
  EXPECT_EQ(numbers_of(lines["outline"].at(0))[1], static_cast<double>(outlines.size()));
  EXPECT_LE(numbers_of(lines["outline"].at(0))[0], 0.01);
  EXPECT_GT(numbers_of(lines["speeds"].at(0))[0], 2.0 * static_cast<double>(lines["road"].size()));
}

TEST(OpenDriveSumo, WithAnOriginOutlinesComeOutInDegrees) {
  NEED_SUMO();
  const DrivenPlace place;
  const auto outlines = test::outlines_along(place.paths);
  SumoCase how{outlines};
  how.origin = GeoOrigin{47.3769, 8.5417, 30.0};
  auto lines = judged_by_sumo(place, how);
  expect_driven(lines, place);
  EXPECT_EQ(numbers_of(lines["outline"].at(0))[1], static_cast<double>(outlines.size()));
}

TEST(OpenDriveSumo, AStreetDrivenBothWaysHasItsTurnsBothWays) {
  NEED_SUMO();
  const DrivenPlace place = test::cross_place();
  ASSERT_EQ(place.network.lanes.size(), 3U);
  auto lines = judged_by_sumo(place, {});
  expect_driven(lines, place);
  // Two streets out of each of two intersections for two ways in, without the one turned back.
  EXPECT_EQ(lines["turn"].size(), 6U);
  EXPECT_EQ(lines["road"].size(), 4U);
}

TEST(OpenDriveSumo, RingsAreCutSoThatNoEdgeFollowsItself) {
  NEED_SUMO();
  for (const bool both_ways : {false, true}) {
    SCOPED_TRACE(both_ways);
    const DrivenPlace place = test::ring_place(both_ways);
    ASSERT_EQ(place.network.lanes.size(), 1U);
    ASSERT_TRUE(place.network.lanes.front().closed);
    auto lines = judged_by_sumo(place, {test::outlines_along(place.paths)});
    expect_driven(lines, place);
    EXPECT_EQ(lines["joint"].size(), both_ways ? 6U : 3U);
  }
}

// Vehicles are slow where x is 40.5 to 43 m, so that the limit changes in two bends.
TEST(OpenDriveSumo, SmallRingsWithTightBendsAreReadWithoutAWarning) {
  NEED_SUMO();
  for (const double radius_m : {2.8, 3.6}) {
    SCOPED_TRACE(radius_m);
    const DrivenPlace place = test::ring_place(true, {13.0, 10.0, radius_m});
    ASSERT_EQ(place.network.lanes.size(), 1U);
    auto lines = judged_by_sumo(place, {});
    expect_driven(lines, place);
  }
}

TEST(OpenDriveSumo, LimitsDoNotChangeInSharpBends) {
  NEED_SUMO();
  for (const double width_m : {43.5, 44.0, 45.0}) {
    SCOPED_TRACE(width_m);
    const DrivenPlace place = test::ring_place(true, {width_m, 30.0, 5.0});
    SumoCase how;
    how.crawl = 1.0;
    auto lines = judged_by_sumo(place, how);
    expect_driven(lines, place);
  }
}

TEST(OpenDriveSumo, LanesMayEndInSharpBends) {
  NEED_SUMO();
  for (const double bend_m : {8.0, 9.0, 10.0}) {
    SCOPED_TRACE(bend_m);
    const DrivenPlace place = test::bent_place(bend_m);
    auto lines = judged_by_sumo(place, {});
    expect_driven(lines, place);
  }
}

TEST(OpenDriveSumo, ALaneThatReturnsToItsIntersectionIsCut) {
  NEED_SUMO();
  for (const bool both_ways : {false, true}) {
    SCOPED_TRACE(both_ways);
    const DrivenPlace place = test::loop_place(both_ways);
    int loops = 0;
    for (const Lane& lane : place.network.lanes)
      loops += lane.from_intersection >= 0 && lane.from_intersection == lane.to_intersection;
    ASSERT_EQ(loops, 1);
    const auto outlines = test::outlines_along(place.paths);
    auto lines = judged_by_sumo(place, {outlines});
    expect_driven(lines, place);
    EXPECT_EQ(lines["joint"].size(), both_ways ? 2U : 1U);
    EXPECT_EQ(numbers_of(lines["outline"].at(0))[1], static_cast<double>(outlines.size()));
  }
}

TEST(OpenDriveSumo, ShortLanesBetweenIntersectionsStayOpen) {
  NEED_SUMO();
  for (const double apart_m : {5.0, 8.0, 13.0}) {
    SCOPED_TRACE(apart_m);
    const DrivenPlace place = test::staggered_place(apart_m);
    auto lines = judged_by_sumo(place, {});
    expect_driven(lines, place);
  }
}

TEST(OpenDriveSumo, LanesOfAnyWidthStayOpenAndOnTheirPath) {
  NEED_SUMO();
  for (const double width_m : {1.2, 12.0}) {
    SCOPED_TRACE(width_m);
    DrivenPlace place = test::cross_place();
    for (LanePath& path : place.paths) path.width_m = width_m;
    ExportNotes notes;
    auto lines = judged_by_sumo(place, {}, &notes);
    expect_driven(lines, place);
    EXPECT_GE(count_noted(notes, width_m < 2.0 ? "narrow widths of lanes" : "full widths of lanes"),
              2U);
  }
}

TEST(OpenDriveSumo, WithoutASpeedMapBendsCountAndTheLossIsSaid) {
  NEED_SUMO();
  const DrivenPlace place = test::cross_place();
  SumoCase how;
  how.speeds = false;
  ExportNotes notes;
  auto lines = judged_by_sumo(place, how, &notes);
  expect_driven(lines, place);
  EXPECT_EQ(count_noted(notes, "speed profiles"), 3U);
}

}  // namespace
}  // namespace roadbook
