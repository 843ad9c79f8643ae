#include <gtest/gtest.h>

#include "base/text_file.hpp"
#include "drive/drive.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "sim/simulate.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/workflows/thrown_problem.hpp"
#include "workflows/occupancy/camera_sights.hpp"
#include "workflows/occupancy/make_occupancy.hpp"

// The occupancy grid of a car with cameras alone.

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using test::thrown_problem;

Landmark landmark_at(const Eigen::Vector3d& p, bool ground) {
  Landmark landmark;
  landmark.p_frame = p;
  landmark.ground = ground;
  landmark.covariance = Eigen::Vector3d(4e-4, 1e-4, 1e-4).asDiagonal();
  return landmark;
}

// A car drives along x on even ground, with a camera 1.2 m above it. Each keyframe sees all
// landmarks; `raised` of them are obstacles at one place. The map frame is turned by 90 degrees: x
// of the frame is y of the map.
Map even_road(int raised = 1) {
  Map map;
  Session session;
  session.name = "road";
  MountedCamera camera;
  camera.name = "cam0";
  camera.T_vehicle_camera.translation() = Eigen::Vector3d(0.0, 0.0, 1.2);
  session.rig.cameras = {camera};
  map.sessions = {session};
  map.map_frames.push_back({pose_from_planar(0.0, 0.0, 0.0)});
  map.map_frames.push_back({pose_from_planar(0.0, 0.0, 1.5707963267948966)});
  for (int i = 0; i < 5; ++i) {
    Keyframe keyframe;
    keyframe.t_ns = i + 1;
    keyframe.T_frame_vehicle = pose_from_planar(0.5 * i, 0.0, 0.0);
    map.keyframes.push_back(keyframe);
  }
  map.landmarks = {landmark_at({5.0, 0.0, 0.0}, true), landmark_at({5.05, 1.05, 0.8}, false),
                   landmark_at({5.0, 2.0, 2.4}, false), landmark_at({30.0, 0.0, 0.0}, true),
                   landmark_at({4.0, 0.0, 0.1}, false)};
  map.landmarks[1].map_frame = 1;
  map.landmarks.push_back(landmark_at({4.0, 1.0, 0.8}, false));
  map.landmarks.back().covariance *= 1000.0;
  for (int i = 1; i < raised; ++i) map.landmarks.push_back(map.landmarks[1]);
  for (int k = 0; k < 5; ++k)
    for (int l = 0; l < static_cast<int>(map.landmarks.size()); ++l) {
      Observation seen;
      seen.keyframe = k;
      seen.landmark = l;
      map.observations.push_back(seen);
    }
  return map;
}

TEST(CameraSights, TakeTheLowPartOfLinesOfSightAndLandmarksAtTheHeightOfObstacles) {
  const CameraSights seen = camera_sights(even_road(), 0);
  ASSERT_EQ(seen.views.size(), 5U);
  EXPECT_EQ(seen.views[2].anchor, 2U);
  // A landmark on the ground and one at 0.8 m. Not: above a car, too far, low, uncertain.
  EXPECT_EQ(seen.on_ground, 1U);
  EXPECT_EQ(seen.raised, 1U);
  ASSERT_EQ(seen.sights.size(), 6U);
  for (std::size_t i = 0; i < 5; ++i) {
    const CameraSight& sight = seen.sights[i];
    EXPECT_FALSE(sight.raised);
    EXPECT_EQ(sight.view, i);
    EXPECT_NEAR((sight.p - Eigen::Vector2d(5.0, 0.0)).norm(), 0.0, 1e-9);
    // 0.3 m is a quarter of 1.2 m: the last quarter of the line is lower.
    const double camera_x = 0.5 * static_cast<double>(i);
    EXPECT_NEAR(sight.low.x(), 5.0 - 0.25 * (5.0 - camera_x), 0.05);
    EXPECT_NEAR(sight.low.y(), 0.0, 1e-9);
  }
  const CameraSight& raised = seen.sights[5];
  EXPECT_TRUE(raised.raised);
  EXPECT_EQ(raised.view, 2U);
  EXPECT_NEAR((raised.p - Eigen::Vector2d(-1.05, 5.05)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(raised.covariance(0, 0), 1e-4, 1e-12);
  EXPECT_NEAR(raised.covariance(1, 1), 4e-4, 1e-12);
}

TEST(DrivenGround, IsHalfAMetreToEachSideOfTheWay) {
  OccupancyGrid grid;
  grid.shape = CellShape{{-3.0, -3.0}, 0.1, 80, 60};
  grid.change.assign(grid.shape.size(), -8.0F);
  grid.seen.assign(grid.shape.size(), 20);
  grid.effective.assign(grid.shape.size(), 20.0F);
  // Nothing was seen at negative x; at negative y everything is called occupied.
  for (int r = 0; r < 60; ++r)
    for (int c = 0; c < 80; ++c) {
      if (c < 30) grid.seen[grid.shape.index(c, r)] = 0;
      if (r < 30) grid.change[grid.shape.index(c, r)] = 8.0F;
    }
  Map map = even_road();
  map.keyframes.resize(1);
  const DrivenGround driven = driven_ground(grid, 0.0, map);
  EXPECT_NEAR(static_cast<double>(driven.cells), 3.14159 * 25.0, 6.0);
  EXPECT_EQ(driven.seen * 2, driven.cells);
  EXPECT_EQ(driven.free * 2, driven.seen);
  EXPECT_EQ(driven.occupied * 2, driven.seen);
}

TEST(MakeOccupancy, CamerasNeedASessionWithLandmarksAndNoScannersOptions) {
  const Folder folder;
  ScenarioOptions small;
  small.size = "small";
  SimulateOptions simulation;
  simulation.images = false;
  simulation.max_duration_s = 2.0;
  simulate(load_scenario("zurich", small), folder / "drive", simulation);
  const fs::path file = folder / "place.gpkg";
  Map map = even_road(10);
  NoMessages messages;
  OccupancyRequest request;
  request.drives = {folder / "drive"};
  request.map = file;
  // No scanner: the message names the other sensor.
  map.sessions[0].drive_digest = Drive::open(folder / "drive").digest();
  MapFileBuilder(file, "key").finish(map, {});
  const Problem none = thrown_problem([&] { (void)make_occupancy(request, messages); });
  EXPECT_EQ(none.field, "range0");
  EXPECT_NE(none.want.find("--sensor cameras"), std::string::npos);
  request.sensor = OccupancySensor::kCameras;
  const OccupancyResult made = make_occupancy(request, messages);
  EXPECT_EQ(made.drives[0].on_ground, 1U);
  EXPECT_EQ(made.drives[0].raised, 10U);
  const auto stored = read_occupancy_layers(MapLayers(file));
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->drives[0].sensor, "cameras");
  EXPECT_EQ(stored->drives[0].sights_raised, made.drives[0].drive.sights_raised);
  EXPECT_EQ(stored->drives[0].updates, static_cast<std::int64_t>(made.drives[0].updates));
  EXPECT_GT(stored->surfaces_per_m, 0.0);
  // The same drive again replaces its sights.
  EXPECT_EQ(make_occupancy(request, messages).stored.drives.size(), 1U);
  OccupancyRequest other = request;
  other.wide_beam_rad = 0.4;
  EXPECT_EQ(thrown_problem([&] { (void)make_occupancy(other, messages); }).field, "--wide-beam");
  other = request;
  other.model = "nominal";
  EXPECT_EQ(thrown_problem([&] { (void)make_occupancy(other, messages); }).field, "--model");
  other = request;
  other.update = OccupancyUpdate::kNaive;
  EXPECT_EQ(thrown_problem([&] { (void)make_occupancy(other, messages); }).field, "--update");
  // No session, or a session without both kinds of landmarks: refused, the map stays as it was.
  map = even_road(0);
  map.landmarks[1].covariance *= 1000.0;
  map.sessions[0].drive_digest = Drive::open(folder / "drive").digest();
  fs::remove(file);
  MapFileBuilder(file, "key").finish(map, {});
  const std::string without = read_regular_file(file, "a map");
  EXPECT_THROW((void)make_occupancy(request, messages), Refused);
  EXPECT_EQ(read_regular_file(file, "a map"), without);
  map = even_road(10);
  map.sessions[0].drive_digest = "another";
  fs::remove(file);
  MapFileBuilder(file, "key").finish(map, {});
  EXPECT_THROW((void)make_occupancy(request, messages), Refused);
}

}  // namespace
}  // namespace roadbook
