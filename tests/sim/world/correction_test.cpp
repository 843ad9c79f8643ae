#include "sensors/correction.hpp"

#include <gtest/gtest.h>

#include "sim/scenario/scenario.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/world.hpp"

namespace roadbook {
namespace {

struct Simulated {
  World world;
  VehicleMotion drive;
  WheelModel model;
};

Simulated small_car_park() {
  ScenarioOptions options;
  options.size = "small";
  World world;
  world.scenario = load_scenario("zurich", options);
  world.ground = Ground(world.scenario.ground, {});
  world.paint.kind = Canvas{cv::Mat::ones(4, 4, CV_8UC1), world.scenario.ground.low, 100.0};
  Random random(5, "driver");
  const Scenario& s = world.scenario;
  VehicleMotion drive =
      drive_line(route_line(s, s.route), s.laps[0], s.stops, s.vehicle, world.ground, {}, random);
  const WheelModel model = nominal_wheels(s.vehicle);
  return {std::move(world), std::move(drive), model};
}

// Largest differences of distance and heading over all seconds of the drive.
Eigen::Vector2d worst_difference(const Simulated& sim,
                                 const WheelOdometry& a,
                                 const WheelOdometry& b) {
  Eigen::Vector2d worst(0.0, 0.0);
  for (int s = 1; s + 2 < static_cast<int>(sim.drive.duration_s()); ++s) {
    const std::int64_t from = s * std::int64_t{1'000'000'000};
    const auto ma = a.between(from, from + 1'000'000'000);
    const auto mb = b.between(from, from + 1'000'000'000);
    if (!ma || !mb) continue;
    worst = worst.cwiseMax(Eigen::Vector2d(std::abs(ma->motion.x() - mb->motion.x()),
                                           std::abs(ma->motion.z() - mb->motion.z())));
  }
  return worst;
}

// The simulation applies an effect, and the correction removes the same effect.
TEST(Correction, TakesOutWhatSimulationPutIn) {
  const Simulated sim = small_car_park();
  StreamOptions options;
  options.noise = false;
  const WheelOdometry nominal(sim.model, simulate_wheels(sim.world, sim.drive, 0, options));
  const EffectSizes all{
      {"wheels0.left_radius", 0.01},       {"wheels0.right_radius", -0.02},
      {"wheels0.radius", 0.015},           {"wheels0.radius_difference", 0.01},
      {"wheels0.track_width", 0.04},       {"wheels0.latency", 0.08},
      {"wheels0.slip_acceleration", 0.01}, {"wheels0.radius_speed", 0.005},
      {"wheels0.eccentricity", 0.02},      {"clock.drift", 1e-3},
  };
  for (const auto& effect : all) {
    SCOPED_TRACE(effect.first);
    const EffectSizes sizes{effect};
    options.effects = sizes;
    const auto read = simulate_wheels(sim.world, sim.drive, 0, options);
    const WheelOdometry wrong(sim.model, read);
    const WheelOdometry right(corrected_wheels(sim.model, sizes),
                              corrected_readings(sim.model, sizes, 0, read));
    const Eigen::Vector2d before = worst_difference(sim, wrong, nominal);
    const Eigen::Vector2d after = worst_difference(sim, right, nominal);
    // Speed and acceleration come from differences of readings: their share of a second remains.
    EXPECT_LT(after.x(), 0.1 * before.x() + 1e-6);
    EXPECT_LT(after.y(), 0.1 * before.y() + 1e-6);
    EXPECT_GT(before.maxCoeff(), 5e-4);
  }
}

TEST(Correction, TakesTheSteeringSensorsFaultsOut) {
  const Simulated sim = small_car_park();
  StreamOptions options;
  options.noise = false;
  const auto nominal = simulate_wheels(sim.world, sim.drive, 0, options);
  const EffectSizes sizes{
      {"steering0.offset", 0.01}, {"steering0.ratio", 0.05}, {"steering0.understeer", 0.002}};
  options.effects = sizes;
  const auto right =
      corrected_readings(sim.model, sizes, 0, simulate_wheels(sim.world, sim.drive, 0, options));
  for (std::size_t i = 0; i < nominal.size(); ++i)
    ASSERT_NEAR(*right[i].steering_rad, *nominal[i].steering_rad, 2e-4) << i;
}

TEST(Correction, ImagesOfALateRigComeTogetherWithTheWheelsOfTheirTime) {
  WheelModel model;
  model.time_offset_s = 0.01;
  EXPECT_DOUBLE_EQ(corrected_wheels(model, {{"cam.latency", 0.03}}).time_offset_s, 0.04);
  EXPECT_DOUBLE_EQ(corrected_wheels(model, {{"wheels0.latency", 0.03}}).time_offset_s, -0.02);
}

TEST(Correction, SaysWhatItCannotTakeOut) {
  EXPECT_EQ(not_corrected({{"ground.slope", 0.01}, {"cam2.focal", 0.01}, {"wheels0.radius", 0.1}}),
            std::vector<std::string>{"ground.slope"});
  // All of a lens, of a mounting and of the time of exposure is corrected.
  for (const EffectInfo& info : camera_effects())
    if (!info.name.ends_with("vignetting") &&
        info.name.find("exposure") == std::string_view::npos) {
      EXPECT_TRUE(not_corrected({{std::string(info.name), 0.01}}).empty()) << info.name;
      if (info.unit == "s") continue;  // StatedMounting and ExposureShift judge times
      MountedCamera nominal;
      nominal.name = "cam0";
      nominal.camera.parameters = {400.0, 400.0, 320.0, 240.0};
      const Rig real = corrected_rig({{nominal}}, {{std::string(info.name), 0.01}});
      EXPECT_TRUE(real.cameras[0].camera.parameters != nominal.camera.parameters ||
                  !real.cameras[0].T_vehicle_camera.isApprox(nominal.T_vehicle_camera, 1e-6))
          << info.name;
    }
}

}  // namespace
}  // namespace roadbook
