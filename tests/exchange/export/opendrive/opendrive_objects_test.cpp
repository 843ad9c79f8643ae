#include <gtest/gtest.h>

#include <algorithm>
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
  std::ifstream file(folder / "place.xodr");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto at = text.find("<object ");
  ASSERT_NE(at, std::string::npos);
  const auto t = text.find(" t=\"", at);
  EXPECT_NEAR(parse_double(text.substr(t + 4, text.find('"', t + 4) - t - 4)).value(), 1.5, 0.1);
}

}  // namespace
}  // namespace roadbook
