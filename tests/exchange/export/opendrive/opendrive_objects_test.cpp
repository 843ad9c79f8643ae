#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <set>
#include <sstream>

#include "base/text.hpp"
#include "exchange/export/export_map.hpp"
#include "exchange/export/planner/planner_map.hpp"
#include "tests/exchange/checker_lines.hpp"
#include "tests/exchange/sumo_places.hpp"
#include "tests/support/command_output.hpp"
#include "tests/support/source_tree.hpp"

// Parking spaces and crossings in OpenDRIVE files, read by the standard.

namespace roadbook {
namespace {

using test::count_noted;
using test::DrivenPlace;
using test::Folder;
using test::output_of;
using test::sumo_lines;

// A number of the first object in a file.
double number_of_object(const std::filesystem::path& path, const std::string& name) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto object = text.find("<object ");
  const auto at = text.find(" " + name + "=\"", object);
  if (object == std::string::npos || at == std::string::npos) return NAN;
  const auto begin = at + name.size() + 3;
  return parse_double(text.substr(begin, text.find('"', begin) - begin)).value_or(NAN);
}

// Reads the file by the standard, without SUMO: outlines and links are exact, also next to sharp
// bends.
TEST(OpenDriveObjects, OutlinesAndLinksAreThoseOfTheMapForAReaderOfTheStandard) {
  const Folder folder;
  const DrivenPlace place = test::loop_place(true);
  const auto outlines = test::outlines_along(place.paths);
  const auto map = test::sumo_map(folder, place, outlines, true);
  export_map(map, "opendrive", folder / "place.xodr");
  const std::string text =
      output_of("python3 " + (test::source_tree() / "tests/exchange/read_opendrive.py").string() +
                " " + (folder / "place.xodr").string());
  auto lines = sumo_lines(text);
  EXPECT_TRUE(lines["problem"].empty()) << text.substr(text.find("problem"), 500);
  std::vector<Eigen::Vector3d> corners;
  for (const std::string& line : lines["corner"]) {
    std::istringstream in(line);
    std::string type, id;
    Eigen::Vector3d p;
    in >> type >> id >> p.x() >> p.y() >> p.z();
    corners.push_back(p);
  }
  EXPECT_EQ(corners.size(), 4 * outlines.size());
  for (const test::Outline& outline : outlines)
    for (const Eigen::Vector2d& p : outline.corners)
      EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& c) {
        return (c - Eigen::Vector3d(p.x(), p.y(), 0.02 * p.x())).norm() < 0.001;
      })) << p.transpose();
  // The link names the place of the lane that is nearest to the open side.
  const PlannerMap planner(map);
  std::set<std::string> expected;
  for (const PlannerSpace& space : planner.spaces())
    if (space.link) {
      const LanePiece& piece = planner.layout().pieces[static_cast<std::size_t>(space.link->piece)];
      ASSERT_FALSE(piece.turned);
      std::ostringstream line;
      line << "space_" << space.id << " " << space.link->lane << " " << std::fixed
           << std::setprecision(6) << space.link->s_m << (space.link->left ? " left" : " right");
      expected.insert(line.str());
    }
  EXPECT_GT(expected.size(), 30U);
  EXPECT_EQ(std::set<std::string>(lines["link"].begin(), lines["link"].end()), expected);
}

TEST(OpenDriveObjects, WhatIsNoRectangleIsCountedAndItsOutlineKept) {
  const Folder folder;
  const DrivenPlace place = test::cross_place();
  test::Outline slanted = test::rectangle("parking_spaces", {17.0, 12.5}, 0.0, 5.0, 2.5);
  slanted.corners[2].x() += 0.8;
  slanted.corners[1].x() += 0.8;
  test::Outline five = test::rectangle("crossings", {30.0, 20.0}, 0.1, 3.0, 5.0);
  five.corners.insert(five.corners.begin() + 1, Eigen::Vector2d(27.5, 20.0));
  const auto map = test::sumo_map(folder, place, {slanted, five}, true);
  ExportNotes notes;
  export_map(map, "opendrive", folder / "place.xodr", {}, &notes);
  EXPECT_EQ(count_noted(notes, "outlines as SUMO reads them"), 2U);
  EXPECT_EQ(count_noted(notes, "speed profiles"), 0U);
  auto lines = sumo_lines(
      output_of("python3 " + (test::source_tree() / "tests/exchange/read_opendrive.py").string() +
                " " + (folder / "place.xodr").string()));
  EXPECT_EQ(lines["corner"].size(), 9U);
}

// A crossing lies next to a lane. Another lane passes 3 m above and is nearer to the middle of the
// crossing.
TEST(OpenDriveObjects, ACrossingBelongsToTheLaneOfItsOwnFloor) {
  const Folder folder;
  DrivenPass low = test::driven_along({{0.0, 0.0}, {60.0, 0.0}});
  DrivenPass high = test::driven_along({{0.0, 2.0}, {60.0, 2.0}});
  for (auto& p : low.positions) p.z() = 0.0;
  for (auto& p : high.positions) p.z() = 3.0;
  const DrivenPlace place = test::driven_place({low, high});
  ASSERT_EQ(place.network.lanes.size(), 2U);
  test::Outline crossing = test::rectangle("crossings", {30.0, 1.5}, 0.0, 3.0, 6.0);
  const auto map = test::sumo_map(folder, place, {crossing}, false);
  export_map(map, "opendrive", folder / "place.xodr");
  EXPECT_NEAR(number_of_object(folder / "place.xodr", "t"), 1.5, 0.1);
}

// No road has the space at its side: it belongs to the end of the road that is nearest.
TEST(OpenDriveObjects, ASpaceBeyondADeadEndIsAtTheEndOfItsRoad) {
  for (const bool behind : {false, true}) {
    const Folder folder;
    const DrivenPlace place = test::driven_place({test::driven_along({{0.0, 0.0}, {60.0, 0.0}})});
    ASSERT_EQ(place.network.lanes.size(), 1U);
    const test::Outline space =
        test::rectangle("parking_spaces", {behind ? -12.0 : 72.0, 1.0}, 0.0, 5.0, 2.5);
    const auto map = test::sumo_map(folder, place, {space}, false);
    export_map(map, "opendrive", folder / "place.xodr");
    EXPECT_NEAR(number_of_object(folder / "place.xodr", "s"), behind ? 0.0 : 60.0, 1.0);
    EXPECT_NEAR(std::abs(number_of_object(folder / "place.xodr", "t")), 1.0, 0.1);
  }
}

}  // namespace
}  // namespace roadbook
