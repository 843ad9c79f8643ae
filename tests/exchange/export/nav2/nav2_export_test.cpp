#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "exchange/export/export_map.hpp"
#include "exchange/export/planner/lane_queries.hpp"
#include "semantics/overhead/geotiff_writer.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/exchange/planner_place.hpp"
#include "tests/exchange/stored_speeds.hpp"
#include "tests/support/command_output.hpp"
#include "tests/support/source_tree.hpp"

// read_nav2.py reads the masks by the rules that Nav2 documents. The tests compare its results with
// those of `export --format path` and `query`.

namespace roadbook {
namespace {

using test::Folder;
using test::output_of;
using test::Stored;

// Returns the numbers that read_nav2.py prints.
std::vector<double> nav2(const std::string& arguments) {
  int status = -1;
  const auto script = test::source_tree() / "tests/exchange/read_nav2.py";
  const std::string text = output_of("python3 " + script.string() + " " + arguments, &status);
  EXPECT_EQ(status, 0) << text;
  std::istringstream in(text);
  std::vector<double> numbers;
  for (double value = 0.0; in >> value;) numbers.push_back(value);
  return numbers;
}

std::string path_in(const Folder& folder, const std::string& name) {
  return (folder / name).string();
}

void write_lines(const std::filesystem::path& file, const std::vector<std::vector<double>>& rows) {
  std::ofstream out(file);
  out.precision(12);
  for (const auto& row : rows) {
    for (const double value : row) out << value << " ";
    out << "\n";
  }
}

// Rectangles 2.5 m wide and 5 m deep; columns as layers from elsewhere have them.
void write_spaces(const std::filesystem::path& map, const std::vector<OrientedBox>& spaces) {
  VectorLayer layer;
  layer.name = "parking_spaces";
  layer.type = GeometryType::kPolygonZ;
  layer.fields = {{"space", FieldType::kInteger}};
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    Feature feature;
    for (const Eigen::Vector2d& p : spaces[i].corners())
      feature.points.emplace_back(p.x(), p.y(), 0.02 * p.x(), 0.0);
    feature.points.push_back(feature.points.front());
    feature.values = {static_cast<std::int64_t>(i + 1)};
    layer.features.push_back(feature);
  }
  MapUpdate update(map);
  update.write_layer(layer);
  update.commit();
}

TEST(Nav2Export, NoFootprintOnALaneOrTurnTouchesAForbiddenCell) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  ExportOptions fine;
  fine.step_m = 1.1;
  export_map(map, "path", folder / "lanes.json", fine);
  // Over both intersections, into the dead end and back, and round the corners.
  int routes = 0;
  for (const auto& [from, to] :
       {std::pair{Eigen::Vector3d(15.0, 0.2, 0.3), Eigen::Vector3d(90.0, 25.0, 1.8)},
        {Eigen::Vector3d(35.0, 25.0, 0.7), Eigen::Vector3d(0.0, 25.0, 0.0)},
        {Eigen::Vector3d(60.0, 50.0, 1.2), Eigen::Vector3d(35.0, 10.0, 0.7)}}) {
    fine.route = {from, to};
    export_map(map, "path", folder / ("route" + std::to_string(routes++) + ".json"), fine);
  }
  for (const double resolution_m : {0.1, 0.3}) {
    ExportOptions options;
    options.resolution_m = resolution_m;
    export_map(map, "nav2", folder / "mask.pgm", options);
    for (const std::string table : {"lanes", "route0", "route1", "route2"}) {
      const auto seen = nav2("footprints " + path_in(folder, "mask_keepout.yaml") + " " +
                             path_in(folder, table + ".json") + " 4.5 1.9 0.9");
      ASSERT_EQ(seen.size(), 2U);
      EXPECT_GT(seen[0], 40.0);
      EXPECT_EQ(seen[1], 0.0) << table << " " << resolution_m;
    }
  }
  // Check of the reader: it finds forbidden cells under a vehicle larger than that of the mask.
  EXPECT_GT(nav2("footprints " + path_in(folder, "mask_keepout.yaml") + " " +
                 path_in(folder, "lanes.json") + " 7 3.4 1.5")[1],
            50.0);
  ExportOptions options;
  options.resolution_m = 0.3;
  options.vehicle = VehicleFootprint{7.0, 3.4, 1.5};
  export_map(map, "nav2", folder / "mask.pgm", options);
  EXPECT_EQ(nav2("footprints " + path_in(folder, "mask_keepout.yaml") + " " +
                 path_in(folder, "lanes.json") + " 7 3.4 1.5")[1],
            0.0);
}

TEST(Nav2Export, EverySpaceBeforeALaneHangsTogetherWithIt) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  // East of the aisle at x = 35; the last one lies where no lane is near.
  const std::vector<OrientedBox> spaces{{{40.0, 15.0}, 0.0, 5.0, 2.5},
                                        {{40.0, 17.5}, 0.0, 5.0, 2.5},
                                        {{40.5, 32.0}, 0.9, 5.0, 2.5},
                                        {{10.0, -6.0}, 1.5708, 5.0, 2.4},
                                        {{15.0, 25.0}, 0.0, 5.0, 2.5}};
  write_spaces(map, spaces);
  std::vector<std::vector<double>> middles;
  for (const OrientedBox& space : spaces) middles.push_back({space.centre.x(), space.centre.y()});
  write_lines(folder / "spaces.txt", middles);
  ExportNotes notes;
  export_map(map, "path", folder / "lanes.json");
  export_map(map, "nav2", folder / "mask.pgm", {}, &notes);
  EXPECT_EQ(nav2("connected " + path_in(folder, "mask_keepout.yaml") + " " +
                 path_in(folder, "lanes.json") + " 1.9 " + path_in(folder, "spaces.txt")),
            (std::vector<double>{1, 1, 1, 1, 0}));
  const auto noted = [&](const std::string& what) {
    for (const ExportNote& note : notes)
      if (note.what == what) return note;
    return ExportNote{};
  };
  EXPECT_EQ(noted("ways to parking spaces").count, 1U);
  EXPECT_NE(noted("ways to parking spaces").why.find("spaces 5"), std::string::npos);
  EXPECT_EQ(noted("links of parking spaces to lanes").count, 4U);
  EXPECT_EQ(noted("speed masks").count, 1U);
  EXPECT_EQ(noted("overhead images").count, 1U);
}

TEST(Nav2Export, GreyThatMapEditorsWriteForUnknownIsNotFree) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  const auto files = export_map(map, "nav2", folder / "mask.pgm");
  EXPECT_EQ(files.size(), 3U) << "no speeds, no speed mask";
  write_lines(folder / "points.txt", {{35.0, 10.0}, {35.0, 10.0}});
  const std::string cells =
      "cells " + path_in(folder, "mask_keepout.yaml") + " " + path_in(folder, "points.txt");
  EXPECT_EQ(nav2(cells)[0], 0.0);
  std::fstream image(folder / "mask_keepout.pgm", std::ios::in | std::ios::out | std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(image)), {});
  std::replace(text.begin() + 30, text.end(), static_cast<char>(254), static_cast<char>(205));
  image.seekp(0);
  image << text;
  image.close();
  EXPECT_EQ(nav2(cells)[0], -1.0);
}

// Returns the answer of `query --at`: the lowest speed of all lanes at the point, or infinity
// without a lane.
double speed_at(const LaneQueries& queries, const Eigen::Vector2d& p) {
  double speed = INFINITY;
  for (const LaneStrips::Strip& strip : queries.strips().strips())
    if (const auto at = strip.frame.project(p); at.inside())
      if (const auto answer = queries.of(strip.lane).at(at.s_m, at.e_m))
        speed = std::min(speed, answer->speed.value);
  return speed;
}

TEST(Nav2Export, NoCellIsFasterThanQuerySaysAtAnyOfItsPoints) {
  Stored stored;
  // The minimum speed is below one step of the mask, and at one place people are always present.
  stored.speeds.options.min_speed = 0.1;
  for (SpeedCell& cell : stored.speeds.cells)
    if ((cell.centre - Eigen::Vector2d(35.0, 20.0)).norm() < 1.0) cell.presence = 1.0;
  MapUpdate update(stored.map);
  write_speed_layers(update, stored.speeds);
  update.commit();
  const LaneQueries queries(stored.map);
  std::vector<std::vector<double>> all;
  std::vector<std::vector<double>> calm;
  Random random(7, "points");
  for (const LaneStrips::Strip& strip : queries.strips().strips())
    for (int i = 0; i < 3000; ++i) {
      const double s = random.uniform(0.0, strip.length_m());
      const auto p =
          strip.frame.position(s, random.uniform(-strip.half_width_m, strip.half_width_m));
      if (!p) continue;
      const double speed = speed_at(queries, *p);
      all.push_back({p->x(), p->y(), speed});
      bool is_calm = true;
      for (int k = 0; k < 8; ++k) {
        const double angle = 0.7854 * k;
        const double near =
            speed_at(queries, *p + 0.15 * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
        is_calm = is_calm && std::abs(near - speed) < 0.1;
      }
      if (is_calm) calm.push_back(all.back());
    }
  write_lines(stored.folder / "all.txt", all);
  write_lines(stored.folder / "calm.txt", calm);
  for (const double resolution_m : {0.1, 1.0}) {
    SCOPED_TRACE(resolution_m);
    ExportOptions options;
    options.resolution_m = resolution_m;
    EXPECT_EQ(export_map(stored.map, "nav2", stored.folder / "mask.pgm", options).size(), 6U);
    const std::string mask = "speeds " + path_in(stored.folder, "mask.yaml") + " " +
                             path_in(stored.folder, "mask_filter.yaml");
    const auto of_all = nav2(mask + " " + path_in(stored.folder, "all.txt"));
    ASSERT_EQ(of_all.size(), 3U);
    EXPECT_LE(of_all[1], 1e-5);  // the reader's and the mask's decimals
    if (resolution_m > 0.1) continue;
    // Where the speed hardly changes, a cell equals the result of `query` within one step of the
    // mask.
    const auto of_calm = nav2(mask + " " + path_in(stored.folder, "calm.txt"));
    EXPECT_GT(calm.size(), 1000U);
    EXPECT_GE(of_calm[0], -of_calm[2] - 0.2);
  }
}

// A space of 5.5 x 2.3 m along the ring's lower side (y = 0). Its short sides are of no use.
TEST(Nav2Export, ASpaceAlongItsLaneIsEnteredOverItsLongSide) {
  const test::PlannerPlace place;
  export_map(place.map, "nav2", place.folder / "mask.pgm");
  export_map(place.map, "path", place.folder / "lanes.json");
  const std::string mask = path_in(place.folder, "mask_keepout.yaml");
  // Before the long side; where a vehicle pulls in, by the direction of the lane from one side
  // alone; beyond both short sides, away from the lane.
  write_lines(place.folder / "points.txt",
              {{50.5, 1.5}, {55.0, 1.5}, {41.5, 3.4}, {64.0, 3.4}, {47.5, 1.5}, {58.0, 1.5}});
  const auto cells = nav2("cells " + mask + " " + path_in(place.folder, "points.txt"));
  ASSERT_EQ(cells.size(), 6U);
  EXPECT_EQ(std::vector<double>(cells.begin(), cells.begin() + 4),
            (std::vector<double>{0, 0, 100, 100}));
  EXPECT_EQ(cells[4] + cells[5], 100.0);
  write_lines(place.folder / "space.txt", {{52.75, 3.05}});
  EXPECT_EQ(nav2("connected " + mask + " " + path_in(place.folder, "lanes.json") + " 1.9 " +
                 path_in(place.folder, "space.txt")),
            std::vector<double>{1});
}

// A dead end whose last metres lead straight to a space.
TEST(Nav2Export, ASpaceAheadOfADeadEndIsReachedFromIt) {
  const Folder folder;
  const auto file = folder / "dead_end.gpkg";
  MapFileBuilder(file, "key").finish(test::small_map(1), {});
  DrivenPass pass;
  for (double x = 0.0; x <= 30.0; x += 0.2) pass.positions.emplace_back(x, 0.0, 0.02 * x);
  const RoadNetwork network = build_road_network({pass});
  MapUpdate update(file);
  const NetworkSource source{"drive 0", "2014-06-24T18:02:59.763Z", 0.02};
  write_network_layers(update, network, source);
  write_path_layers(update, lane_paths(network, {pass}), network, source);
  update.commit();
  write_spaces(file, {{{36.5, 0.3}, 0.0, 5.0, 2.5}});
  export_map(file, "path", folder / "lanes.json");
  export_map(file, "nav2", folder / "mask.pgm");
  write_lines(folder / "space.txt", {{36.5, 0.3}});
  EXPECT_EQ(nav2("connected " + path_in(folder, "mask_keepout.yaml") + " " +
                 path_in(folder, "lanes.json") + " 1.9 " + path_in(folder, "space.txt")),
            std::vector<double>{1});
}

// The lot has one aisle and an overhead image. Landmarks form a wall along y = 5. No other ground
// is known.
TEST(Nav2Export, GroundBehindAWallIsForbiddenAndBeforeItFree) {
  const Folder folder;
  const test::Lot lot;
  Map map = test::lot_map(lot);
  for (int i = 0; i < 120; ++i)
    for (const double z : {0.5, 0.9, 1.2}) {
      Landmark landmark;
      landmark.map_frame = 0;
      landmark.p_frame =
          map.map_frames[0].T_map_frame.inverse() * Eigen::Vector3d(-5.0 + 0.3 * i, 5.0, z);
      landmark.covariance.setIdentity();
      landmark.covariance *= 1e-6;
      map.landmarks.push_back(landmark);
    }
  const auto file = folder / "lot.gpkg";
  MapFileBuilder(file, "lot").finish(map, {});
  test::write_lot_picture(file, lot);
  // Lanes as driven along the aisle.
  DrivenPass pass;
  for (double x = 0.0; x <= 24.0; x += 0.2) pass.positions.emplace_back(x, 0.0, 0.0);
  const RoadNetwork network = build_road_network({pass});
  MapUpdate update(file);
  const NetworkSource source{"lot", "2014-06-24T18:02:59.763Z", 0.02};
  write_network_layers(update, network, source);
  write_path_layers(update, lane_paths(network, {pass}), network, source);
  update.commit();
  ExportNotes notes;
  export_map(file, "nav2", folder / "mask.pgm", {}, &notes);
  // The points lie on the lane, in seen ground next to it, in the wall, behind the wall, in seen
  // ground on the other side, and in unseen ground.
  write_lines(folder / "points.txt",
              {{12.0, 0.0}, {12.0, 4.0}, {12.0, 5.0}, {12.0, 7.0}, {12.0, -7.0}, {-6.0, 3.0}});
  EXPECT_EQ(
      nav2("cells " + path_in(folder, "mask_keepout.yaml") + " " + path_in(folder, "points.txt")),
      (std::vector<double>{0, 0, 100, 100, 0, 100}));
  // A parking space behind the wall is free ground, but no way leads through the wall.
  write_spaces(file, {{{12.0, 8.0}, 1.5708, 5.0, 2.5}});
  write_lines(folder / "space.txt", {{12.0, 8.0}});
  export_map(file, "path", folder / "lanes.json");
  ExportNotes cut_off;
  export_map(file, "nav2", folder / "mask.pgm", {}, &cut_off);
  EXPECT_EQ(
      nav2("cells " + path_in(folder, "mask_keepout.yaml") + " " + path_in(folder, "space.txt")),
      std::vector<double>{0});
  EXPECT_EQ(nav2("connected " + path_in(folder, "mask_keepout.yaml") + " " +
                 path_in(folder, "lanes.json") + " 1.9 " + path_in(folder, "space.txt")),
            std::vector<double>{0});
  EXPECT_TRUE(std::any_of(cut_off.begin(), cut_off.end(), [](const ExportNote& note) {
    return note.what == "ways to parking spaces" && note.count == 1;
  }));
  for (const ExportNote& note : notes) EXPECT_NE(note.what, "overhead images");
}

}  // namespace
}  // namespace roadbook
