#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <set>

#include "base/error.hpp"
#include "exchange/export/export_map.hpp"
#include "exchange/export/planner/crosswalk.hpp"
#include "exchange/export/planner/lanelets.hpp"
#include "roadnet/paths/path_frame.hpp"
#include "tests/exchange/export/lanelet2/lanelet2_files.hpp"
#include "tests/exchange/planner_place.hpp"
#include "tests/exchange/planner_routes.hpp"
#include "tests/roadnet/random_lots.hpp"

// check_lanelet2.py checks Lanelet2 files, without and with the extensions of Autoware. It applies
// the rules of the libraries that read such files.

namespace roadbook {
namespace {

using test::check_osm;
using test::kPlaceOnEarth;
using test::lines_with;
using test::number_in;
using test::problems_of;
using test::written;

Eigen::Vector2d east_north(const Eigen::Vector2d& p) {
  return Eigen::Rotation2Dd(kPlaceOnEarth.x_axis_deg * std::numbers::pi / 180.0) * p;
}
Eigen::Vector2d in_map(double east, double north) {
  return Eigen::Rotation2Dd(-kPlaceOnEarth.x_axis_deg * std::numbers::pi / 180.0) *
         Eigen::Vector2d(east, north);
}

TEST(Lanelet2Export, APlainFileHasNoFaultForACheckerOfItsOwn) {
  const test::PlannerPlace place;
  ExportNotes notes;
  const auto file = written(place.map, "lanelet2", &notes);
  int status = -1;
  const std::string text = check_osm(file, "", &status);
  EXPECT_EQ(status, 0) << problems_of(text);
  EXPECT_EQ(lines_with(text, "area").size(), test::spaces_of_place().size());
  EXPECT_EQ(lines_with(text, "crosswalk").size(), test::crossings_of_place().size());
  EXPECT_EQ(test::output_of("xmllint --noout " + file.string()), "");
  const std::string info = test::output_of("ogrinfo -ro -so " + file.string() + " lines");
  EXPECT_NE(info.find("Feature Count"), std::string::npos) << info;
  // The plain profile cannot hold links to lanes. One outline is not a rectangle.
  std::map<std::string, std::size_t> left_out;
  for (const ExportNote& note : notes) left_out[note.what] = note.count;
  EXPECT_EQ(left_out["links of parking spaces to lanes"], test::kLinkedSpaces);
  EXPECT_EQ(left_out["outlines of crossings"], 1U);
}

// The bounds lie half the lane's width from its path, and the limits do not exceed its profile.
TEST(Lanelet2Export, LaneletsLieWhereTheLanesAreAndAreNoFaster) {
  const test::PlannerPlace place;
  const auto file = written(place.map, "lanelet2");
  const std::string text = check_osm(file, "", nullptr);
  const PlannerMap planner(place.map);
  std::map<std::string, double> limits;
  for (const auto& l : lines_with(text, "lanelet")) limits[l[0]] = number_in(l[1]) / 3.6;
  std::map<std::string, std::vector<std::vector<std::string>>> bounds;
  for (auto& b : lines_with(text, "bound")) bounds[b[0]].push_back(b);
  std::size_t compared = 0;
  double fastest = 0.0;
  for (const Lanelet& lanelet : lanelets_of(planner).lanelets) {
    if (lanelet.piece < 0) continue;
    const LanePiece& piece = planner.layout().pieces[static_cast<std::size_t>(lanelet.piece)];
    const PathFrame frame(piece.curve, {-3.0, 3.0});
    const LaneProfile* profile = nullptr;
    for (const LaneProfile& one : place.speeds.profiles)
      if (one.lane == piece.id) profile = &one;
    ASSERT_NE(profile, nullptr);
    const std::string id = std::to_string(lanelet.id);
    fastest = std::max(fastest, limits.at(id));
    for (const auto& b : bounds.at(id)) {
      const auto at = frame.project(in_map(number_in(b[2]), number_in(b[3])));
      if (!at.inside()) continue;  // the last point at a dead end, rounded over it
      EXPECT_NEAR(at.e_m, (b[1] == "left" ? 0.5 : -0.5) * piece.width_m, 0.01);
      EXPECT_NEAR(number_in(b[4]), piece.curve.at(at.s_m).height_m, 0.01);
      const double s = piece.turned ? piece.curve.length_m() - at.s_m : at.s_m;
      EXPECT_LE(limits.at(id), profile->speed_at(s) + 0.02);
      ++compared;
    }
  }
  EXPECT_GT(compared, 200U);
  EXPECT_GT(fastest, 4.0);
}

// Searches routes on lanelets by travel time and compares them with the routes of the layout.
TEST(Lanelet2Export, EveryWayOfTheMapIsARouteByTime) {
  const test::PlannerPlace place;
  const PlannerMap planner(place.map);
  const auto network = lanelets_of(planner);
  for (const char* profile : {"lanelet2", "autoware"}) {
    SCOPED_TRACE(profile);
    const std::string text = check_osm(written(place.map, profile), profile, nullptr);
    std::set<std::pair<std::string, std::string>> routes;
    for (const auto& r : lines_with(text, "route"))
      routes.emplace(r[0] + " " + r[1], r[2] + " " + r[3]);
    // First lanelets of the lanes, with the names that the checker prints.
    std::map<test::DrivenLane, std::string> names;
    for (const Lanelet& lanelet : network.lanelets) {
      if (lanelet.piece < 0 ||
          lanelet.id != planner.layout().pieces[static_cast<std::size_t>(lanelet.piece)].id)
        continue;
      names[{lanelet.piece, true}] = std::to_string(lanelet.id) + " ahead";
      if (!lanelet.both_ways) continue;
      names[{lanelet.piece, false}] = profile == std::string("autoware")
                                          ? std::to_string(id_of_way_back(lanelet)) + " ahead"
                                          : std::to_string(lanelet.id) + " back";
    }
    ASSERT_GT(names.size(), 6U);
    std::size_t reachable = 0;
    for (const auto& [from, from_name] : names) {
      const auto there = test::reachable_lanes(planner.layout(), from);
      for (const auto& [to, to_name] : names) {
        if (from == to) continue;
        EXPECT_EQ(routes.contains({from_name, to_name}), there.contains(to))
            << from_name << " to " << to_name;
        reachable += there.contains(to) ? 1 : 0;
      }
    }
    EXPECT_GT(reachable, 20U);
  }
}

TEST(Lanelet2Export, AutowareFindsTheLaneOfEachSpace) {
  const test::PlannerPlace place;
  ExportNotes notes;
  const auto file = written(place.map, "autoware", &notes);
  int status = -1;
  const std::string text = check_osm(file, "autoware", &status);
  EXPECT_EQ(status, 0) << problems_of(text);
  EXPECT_EQ(test::output_of("xmllint --noout " + file.string()), "");
  const PlannerMap planner(place.map);
  const auto network = lanelets_of(planner);
  std::map<std::string, int> pieces;
  for (const Lanelet& lanelet : network.lanelets) {
    pieces[std::to_string(lanelet.id)] = lanelet.piece;
    pieces[std::to_string(id_of_way_back(lanelet))] = lanelet.piece;
  }
  const auto found = lines_with(text, "space");
  ASSERT_EQ(found.size(), static_cast<std::size_t>(test::kLinkedSpaces));
  std::size_t matched = 0;
  for (const PlannerSpace& space : planner.spaces()) {
    if (!space.rectangle || !space.link) continue;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const auto& corner : space.corners) middle += 0.25 * east_north(corner.head<2>());
    for (const auto& words : found) {
      const Eigen::Vector2d front(number_in(words[2]), number_in(words[3]));
      const Eigen::Vector2d back(number_in(words[4]), number_in(words[5]));
      if ((0.5 * (front + back) - middle).norm() > 0.01) continue;
      ++matched;
      EXPECT_EQ(pieces.at(words[1]), space.link->piece);
      const double ground = (back - front).norm() * number_in(words[6]);
      EXPECT_NEAR(ground, 12.5, 1.6);
    }
  }
  EXPECT_EQ(matched, found.size());
  std::size_t without = 0;
  for (const ExportNote& note : notes) without += note.what == "parking spaces" ? note.count : 0;
  EXPECT_EQ(without + found.size(), test::spaces_of_place().size());
}

// The places have only ring roads: each lane returns to its start.
TEST(Lanelet2Export, ARingIsCutInLanelets) {
  for (const bool both_ways : {false, true}) {
    const test::Folder folder;
    auto passes = test::drive_round({60.0, 35.0, 5.5}, 3, 0.1, 4);
    if (both_ways)
      for (std::size_t i = 0, n = passes.size(); i < n; ++i) {
        passes.push_back(passes[i]);
        std::reverse(passes.back().positions.begin(), passes.back().positions.end());
      }
    const auto map = test::map_of_passes(folder, passes);
    for (const char* profile : {"lanelet2", "autoware"}) {
      int status = -1;
      const std::string text = check_osm(written(map, profile), profile, &status);
      EXPECT_EQ(status, 0) << problems_of(text);
      EXPECT_GE(lines_with(text, "lanelet").size(), 2U);
      EXPECT_GE(lines_with(text, "route").size(), 2U);
    }
  }
}

TEST(Lanelet2Export, FilesOfRandomCarParksHaveNoFault) {
  std::size_t spaces = 0;
  for (int shape = 0; shape < test::kLotShapes; ++shape) {
    const std::uint64_t seed = 10 + static_cast<std::uint64_t>(shape);
    const test::Lot lot = test::random_lot(shape, seed);
    SCOPED_TRACE(::testing::Message() << lot.name << ", seed " << seed);
    const test::Folder folder;
    std::vector<LanePath> paths;
    const auto map = test::map_of_passes(folder, test::drive_lot(lot, 3, 0.1, 0.2, seed), &paths);
    test::add_random_places(map, paths, seed);
    for (const char* profile : {"lanelet2", "autoware"}) {
      ExportNotes notes;
      const auto file = written(map, profile, &notes);
      int status = -1;
      const std::string text = check_osm(file, profile, &status);
      EXPECT_EQ(status, 0) << profile << "\n" << problems_of(text).substr(0, 2000);
      for (const ExportNote& note : notes) EXPECT_NE(note.what.substr(0, 6), "bounds");
      spaces += lines_with(text, "space").size();
    }
  }
  EXPECT_GT(spaces, 60U);
}

TEST(Lanelet2Export, LanesKeepTheirIds) {
  const test::PlannerPlace place;
  const std::string text = check_osm(written(place.map, "lanelet2"), "", nullptr);
  std::set<std::string> ids;
  for (const auto& l : lines_with(text, "lanelet")) ids.insert(l[0]);
  for (const Lane& lane : place.place.network.lanes)
    EXPECT_TRUE(ids.contains(std::to_string(lane.id)));
}

TEST(Lanelet2Export, UnknownProfilesAreRefusedWithTheOnesThereAre) {
  const test::Folder folder;
  ExportOptions options;
  options.origin = kPlaceOnEarth;
  options.profile = "apollo";
  try {
    export_map(test::map_with_paths(folder), "lanelet2", folder / "place.osm", options);
    FAIL();
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("lanelet2, autoware"), std::string::npos);
  }
}

// The aisle at x = 35 runs along y, the lower side of the ring along x.
TEST(Lanelet2Export, PedestriansWalkAcrossTheNearestLane) {
  const test::PlannerPlace place;
  const PlannerMap planner(place.map);
  ExportNotes notes;
  const auto walks = crosswalks_of(planner, lanelets_of(planner), true, notes);
  ASSERT_EQ(walks.size(), test::crossings_of_place().size());
  const auto walked = [](const Crosswalk& walk) {
    return Eigen::Vector2d((walk.left[1] - walk.left[0]).head<2>().normalized());
  };
  EXPECT_GT(std::abs(walked(walks[0]).x()), 0.99);
  EXPECT_GT(std::abs(walked(walks[1]).y()), 0.99);
  for (const Crosswalk& walk : walks) {
    EXPECT_FALSE(walk.crossed.empty());
    EXPECT_GT((walk.right[1] - walk.right[0]).dot(walk.left[1] - walk.left[0]), 0.0);
  }
}

}  // namespace
}  // namespace roadbook
