#include "drive/drive.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "drive/true_poses.hpp"
#include "sim/simulate.hpp"
#include "sim/world/world.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

Scenario tiny(int visit = 0) {
  ScenarioOptions options;
  options.size = "small";
  options.image_scale = 0.25;
  options.visit = visit;
  Scenario scenario = load_scenario("zurich", options);
  scenario.ground.texel_m = 0.04;  // seconds instead of tens of them
  return scenario;
}

fs::path fresh(const std::string& name) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("roadbook_sim_" + name);
  fs::remove_all(folder);
  return folder;
}

std::map<std::string, std::string> content(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    files[fs::relative(entry.path(), folder).string()] = text.str();
  }
  return files;
}

SimulateOptions brief() {
  SimulateOptions options;
  options.max_duration_s = 0.4;
  return options;
}

TEST(Simulate, GivesTheSameBytesOnAnyNumberOfThreads) {
  SimulateOptions options = brief();
  std::map<std::string, std::string> first;
  for (const int threads : {1, 3, 8}) {
    SCOPED_TRACE(threads);
    options.num_threads = threads;
    const fs::path out = fresh("threads");
    (void)simulate(tiny(1), out, options);
    const auto files = content(out);
    if (first.empty()) first = files;
    EXPECT_EQ(files.size(), first.size());
    for (const auto& [name, bytes] : first) EXPECT_TRUE(files.at(name) == bytes) << name;
  }
  EXPECT_GT(first.size(), 24U);
}

// Visits with other parked cars, drivers and noise share the frame of their truth.
TEST(Simulate, DrivesOfOnePlaceNameTheSameWorld) {
  const auto world_of = [](const Scenario& scenario, std::uint64_t seed) {
    SimulateOptions options = brief();
    options.seed = seed;
    const fs::path out = fresh("world");
    (void)simulate(scenario, out, options);
    return true_world(Drive::open(out));
  };
  EXPECT_EQ(world_of(tiny(0), 1), "zurich, size small, seed 11");
  EXPECT_EQ(world_of(tiny(2), 5), "zurich, size small, seed 11");
  Scenario other = tiny(0);
  other.seed = 12;
  EXPECT_EQ(world_of(other, 1), "zurich, size small, seed 12");
  fs::remove_all(fresh("world"));
}

TEST(Simulate, ADriveReadsBackWithItsTruth) {
  const fs::path out = fresh("read");
  const SimulationSummary summary = simulate(tiny(1), out, brief());
  const Drive drive = Drive::open(out);
  EXPECT_TRUE(drive.warnings().empty());
  EXPECT_EQ(drive.rig().cameras.size(), 4U);
  EXPECT_EQ(drive.frame_count(), summary.frames);
  EXPECT_EQ(drive.truth().size(), summary.frames);
  EXPECT_GE(drive.wheel_readings().size(), 20U);
  EXPECT_FALSE(drive.read_image(0, 3).empty());
  const auto world = nlohmann::json::parse(std::ifstream(out / "truth" / "world.json"));
  EXPECT_EQ(world["spaces"].size(), 12U);
  EXPECT_EQ(world["crossings"].size(), 2U);
  EXPECT_EQ(summary.pedestrians, 2U);
}

TEST(Simulate, ACameraThatDiesLeavesNoImagesFromThen) {
  const fs::path out = fresh("dead");
  SimulateOptions options = brief();
  options.camera_dies_s["cam2"] = 0.2;
  (void)simulate(tiny(), out, options);
  const Drive drive = Drive::open(out);
  for (std::size_t frame = 0; frame < drive.frame_count(); ++frame) {
    EXPECT_TRUE(drive.has_image(frame, 0));
    EXPECT_EQ(drive.has_image(frame, 2), frame < 3);  // 0, 0.08 and 0.16 s
  }
}

TEST(Simulate, AnUnknownEffectIsBadInput) {
  SimulateOptions options = brief();
  options.effects["wheels0.radus"] = 0.01;
  EXPECT_THROW((void)simulate(tiny(), fresh("unknown"), options), BadInput);
}

TEST(Simulate, AnEffectThatWouldDoNothingIsRefused) {
  for (const std::string name : {"friction0.drying", "friction0.slip_bias", "detector.range",
                                 "range0.bias", "imu0.gyro_bias", "cam4.focal"}) {
    SCOPED_TRACE(name);
    SimulateOptions options = brief();
    options.effects[name] = 0.01;
    Scenario without_gyro = tiny();
    without_gyro.imu = false;
    try {
      (void)simulate(without_gyro, fresh("unused"), options);
      FAIL() << "accepted";
    } catch (const BadInput& e) {
      EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
    }
  }
}

TEST(Simulate, SquaresAndTheirCarsMoveAndTheTruthSaysWhere) {
  const Scenario scenario = tiny();
  const auto all = moved_patches(scenario, 1.0, 5);
  const auto some = moved_patches(scenario, 0.25, 5);
  EXPECT_NEAR(static_cast<double>(some.size()), 0.25 * static_cast<double>(all.size()), 0.51);
  EXPECT_NE(some.front().low, moved_patches(scenario, 0.25, 6).front().low);
  const World before = make_world(scenario, {}, 1);
  const World after = make_world(scenario, {}, 1, {}, all);
  std::size_t cars = 0;
  for (std::size_t i = 0; i < before.layout.cars.size(); ++i) {
    const Eigen::Vector2d shift = after.layout.cars[i].centre - before.layout.cars[i].centre;
    cars += shift.norm() > 0.2 && shift.norm() < 0.7 ? 1 : 0;
  }
  EXPECT_GT(cars, before.layout.cars.size() / 2);
  SimulateOptions options = brief();
  options.images = false;
  options.ranges = true;  // what shows it; without, the effect is refused
  options.effects["map.moved_landmarks"] = 0.25;
  const fs::path out = fresh("moved");
  (void)simulate(scenario, out, options);
  std::ifstream in(out / "truth/world.json");
  EXPECT_EQ(nlohmann::json::parse(in)["moved"].size(), some.size());
}

TEST(Simulate, WhatIsGoneHasNoCarsAndNoPaintAndTheTruthSaysWhere) {
  const Scenario scenario = tiny();
  const auto all = removed_patches(scenario, 1.0, 5);
  const World before = make_world(scenario, {}, 1);
  const World after = make_world(scenario, {}, 1, {}, all);
  const auto holds = [&](const Eigen::Vector2d& p) {
    return std::any_of(all.begin(), all.end(), [&](const MovedPatch& m) { return m.holds(p); });
  };
  std::size_t beside = 0;
  for (const ParkedCar& car : before.layout.cars) beside += holds(car.centre) ? 1 : 0;
  EXPECT_GT(beside, 0U);
  EXPECT_EQ(after.layout.cars.size() + beside, before.layout.cars.size());
  const Canvas& kind = after.paint.kind;
  for (int y = 0; y < kind.image.rows; ++y)
    for (int x = 0; x < kind.image.cols; ++x)
      // Only whole texels count, because rounding decides on texels at the edge of a square.
      if (holds(kind.low + kind.texel_m * Eigen::Vector2d(x, y)) &&
          holds(kind.low + kind.texel_m * Eigen::Vector2d(x + 1, y + 1))) {
        ASSERT_NE(kind.image.at<std::uint8_t>(y, x), static_cast<int>(SurfaceClass::kMarking));
      }
  EffectSizes effects{{"map.landmarks_gone", 0.5}, {"map.moved_landmarks", 1.0}};
  const auto both = changed_patches(scenario, effects, 5);
  EXPECT_EQ(both.size(), all.size());  // a removed square has not moved
  SimulateOptions options = brief();
  options.images = false;
  options.ranges = true;  // what shows it; without, the effect is refused
  options.effects["map.landmarks_gone"] = 0.25;
  const fs::path out = fresh("gone");
  (void)simulate(scenario, out, options);
  std::ifstream in(out / "truth/world.json");
  const auto world = nlohmann::json::parse(in);
  EXPECT_EQ(world["gone"].size(), removed_patches(scenario, 0.25, options.seed).size());
  EXPECT_TRUE(world["moved"].empty());
}

TEST(Simulate, AMapThatIsOffGivesWrongReferencePosesAndTheTruthHoldsTheRightOnes) {
  SimulateOptions options = brief();
  options.images = false;
  options.max_duration_s = 6.0;
  const fs::path without = fresh("map_right");
  (void)simulate(tiny(), without, options);
  const Drive right = Drive::open(without);
  options.effects = {{"map.scale", 0.02}, {"map.bend", -3e-4}};
  const fs::path out = fresh("map_off");
  (void)simulate(tiny(), out, options);
  const Drive off = Drive::open(out);
  const auto truth = right.truth();
  const auto hidden = true_poses(off);
  const auto given = off.truth();
  ASSERT_EQ(hidden.size(), truth.size());
  ASSERT_EQ(given.size(), truth.size());
  const Eigen::Vector3d first = truth.front().T_world_vehicle.translation();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_TRUE(hidden[i].T_world_vehicle.isApprox(truth[i].T_world_vehicle, 1e-9));
    const Eigen::Vector3d d = truth[i].T_world_vehicle.translation() - first;
    const Eigen::Vector3d want(d.x(), d.y() - 0.5 * 3e-4 * d.x() * d.x(), d.z());
    EXPECT_LT((given[i].T_world_vehicle.translation() - first - 1.02 * want).norm(), 1e-6);
  }
  EXPECT_TRUE(true_poses(right).size() == truth.size());
  EXPECT_FALSE(fs::exists(right.folder() / "truth" / "poses"));
  // The wheel readings follow the car, not the map.
  EXPECT_EQ(off.wheel_readings().back().left_angle_rad,
            right.wheel_readings().back().left_angle_rad);
}

TEST(Simulate, IsInterruptedWhileThePlaceIsPainted) {
  int asked = 0;
  const auto progress = [&](std::string_view, std::size_t, std::size_t) { return ++asked < 5; };
  EXPECT_THROW((void)make_world(tiny(), {}, 2, progress), Interrupted);
  EXPECT_EQ(asked, 5);  // nothing runs after the answer
}

}  // namespace
}  // namespace roadbook
