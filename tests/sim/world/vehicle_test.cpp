#include "sim/world/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/se3.hpp"
#include "sensors/wheels.hpp"
#include "sim/streams/range_stream.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/world/world.hpp"

namespace roadbook {
namespace {

Scenario small(const std::string& name) {
  ScenarioOptions options;
  options.size = "small";
  return load_scenario(name, options);
}

VehicleMotion drive(const Scenario& scenario, const Ground& ground) {
  Random random(5, "driver");
  return drive_line(route_line(scenario, scenario.route), scenario.laps[0], scenario.stops,
                    scenario.vehicle, ground, {}, random);
}

/// A world of its ground alone, for streams that look at nothing else.
World bare(const Scenario& scenario, const GroundEffects& effects = {}) {
  World world;
  world.scenario = scenario;
  world.ground = Ground(scenario.ground, effects);
  world.paint.kind = Canvas{cv::Mat::ones(4, 4, CV_8UC1), scenario.ground.low, 100.0};
  return world;
}

TEST(Vehicle, KeepsTheLimitsOfCarAndDriver) {
  for (const std::string name : {"zurich", "stuttgart", "road"}) {
    SCOPED_TRACE(name);
    const Scenario scenario = small(name);
    const VehicleSpec& v = scenario.vehicle;
    const VehicleMotion trajectory = drive(scenario, Ground(scenario.ground));
    const auto& states = trajectory.states();
    EXPECT_EQ(states.front().speed, 0.0);
    EXPECT_EQ(states.back().speed, 0.0);
    for (std::size_t i = 1; i < states.size(); ++i) {
      const double dt = states[i].t_s - states[i - 1].t_s;
      EXPECT_LE(states[i].speed, v.max_speed + 1e-9);
      const double a = (states[i].speed - states[i - 1].speed) / dt;
      EXPECT_LE(a, v.max_acceleration + 1e-9);
      EXPECT_GE(a, -v.max_braking - 1e-9);
      EXPECT_LE(std::abs(states[i].steering), v.max_steering + 1e-12);
      EXPECT_LE(std::abs(states[i].steering - states[i - 1].steering),
                v.max_steering_rate * dt + 1e-12);
    }
  }
}

TEST(Vehicle, StaysInItsLane) {
  const Scenario scenario = small("zurich");
  const DrivingLine line = route_line(scenario, scenario.route);
  const VehicleMotion trajectory = drive(scenario, Ground(scenario.ground));
  double s = 0.0;
  for (const VehicleState& state : trajectory.states()) {
    s = line.nearest({state.x, state.y}, s, 0.5);
    // The lane is 4.4 m wide and the car 1.8 m: 1.3 m on either side.
    EXPECT_LT((line.at(s) - Eigen::Vector2d(state.x, state.y)).norm(), 1.0);
  }
}

TEST(Vehicle, StandsAsLongAsEachStopSays) {
  Scenario scenario = small("zurich");
  scenario.laps[0] = 1;
  scenario.stops = {{.at_m = 12.0, .seconds = 2.0}, {.at_m = 25.0, .seconds = 5.0}};
  const VehicleMotion motion = drive(scenario, Ground(scenario.ground));
  std::vector<double> stands;
  double since = 0.0;
  for (const VehicleState& state : motion.states()) {
    if (state.speed > 0.0) {
      if (state.t_s - since > 0.1 && since > 1.0) stands.push_back(state.t_s - since);
      since = state.t_s;
    }
  }
  ASSERT_EQ(stands.size(), 2U);
  // The last part of the braking, from a slow roll to rest, belongs to the stop.
  EXPECT_NEAR(stands[0], 2.0, 0.3);
  EXPECT_NEAR(stands[1], 5.0, 0.3);
}

TEST(Vehicle, WheelsIntegrateToTheTruthOnFlatGround) {
  Scenario scenario = small("zurich");
  scenario.ground.hinge.reset();
  const World world = bare(scenario);
  const VehicleMotion trajectory = drive(scenario, world.ground);
  StreamOptions options;
  options.noise = false;
  const auto readings = simulate_wheels(world, trajectory, 0, options);
  const WheelModel model = nominal_wheels(scenario.vehicle);
  const WheelOdometry odometry(model, readings);
  const auto motion = odometry.between(readings.front().t_ns, readings.back().t_ns);
  ASSERT_TRUE(motion.has_value());
  const double t = 1e-9 * static_cast<double>(readings.back().t_ns);
  const Eigen::Isometry3d truth =
      trajectory.T_world_vehicle(0.0).inverse() * trajectory.T_world_vehicle(t);
  // Readings every 5 cm, integrated as arcs: the sagitta within one is below 1e-5 m, and the drive
  // has about 1600 of them, whose errors mostly cancel round the loop.
  EXPECT_NEAR(motion->motion.x(), truth.translation().x(), 0.01);
  EXPECT_NEAR(motion->motion.y(), truth.translation().y(), 0.01);
  EXPECT_NEAR(wrap_angle(motion->motion.z() - heading_of(truth)), 0.0, 1e-3);
}

TEST(Vehicle, ALargerWheelTurnsLessBySoMuch) {
  Scenario scenario = small("zurich");
  const World world = bare(scenario);
  const VehicleMotion trajectory = drive(scenario, world.ground);
  StreamOptions options;
  options.noise = false;
  const auto nominal = simulate_wheels(world, trajectory, 0, options).back();
  options.effects["wheels0.left_radius"] = 0.02;
  const auto changed = simulate_wheels(world, trajectory, 0, options).back();
  EXPECT_NEAR(changed.left_angle_rad, nominal.left_angle_rad / 1.02, 1e-6);
  EXPECT_EQ(changed.right_angle_rad, nominal.right_angle_rad);
}

TEST(Vehicle, LatentWheelsShowThePast) {
  Scenario scenario = small("zurich");
  const World world = bare(scenario);
  const VehicleMotion trajectory = drive(scenario, world.ground);
  StreamOptions options;
  options.noise = false;
  const auto nominal = simulate_wheels(world, trajectory, 0, options);
  options.effects["wheels0.latency"] = 0.1;
  const auto late = simulate_wheels(world, trajectory, 0, options);
  for (std::size_t i = 5; i < late.size(); ++i) {
    EXPECT_EQ(late[i].t_ns, nominal[i].t_ns);
    EXPECT_NEAR(late[i].left_angle_rad, nominal[i - 5].left_angle_rad, 1e-9);
  }
}

TEST(Vehicle, StandsOnBothSidesOfAHinge) {
  GroundSpec spec;
  spec.hinge = HingeSpec{{0.0, 0.0}, {1.0, 0.0}, 0.035, 0.0};
  const Ground ground(spec);
  EXPECT_NEAR(ground.height(3.0, 2.0), 0.07, 1e-12);
  EXPECT_NEAR(ground.height(3.0, -2.0), 0.07, 1e-12);
  // All four wheels on one side, heading uphill: pitched by the slope, on the ground.
  const Eigen::Isometry3d T = ground.stand(0.0, 5.0, 0.5 * M_PI, 2.6, 1.5);
  EXPECT_NEAR(T.translation().z(), 5.0 * 0.035, 1e-12);
  EXPECT_NEAR(std::asin(T.linear()(2, 0)), std::atan(0.035), 1e-12);
  // Astride of it, level, heading along it: both sides lift the car the same.
  const Eigen::Isometry3d astride = ground.stand(0.0, 0.0, 0.0, 2.6, 1.5);
  EXPECT_NEAR(astride.linear()(2, 2), 1.0, 1e-12);
  EXPECT_NEAR(astride.translation().z(), 0.75 * 0.035, 1e-12);
}

// Pure pursuit steers so that the arc to a point ahead is driven; on a circle that arc is the
// circle, whatever the distance of the point.
TEST(Vehicle, FollowsACircleWithoutCuttingIt) {
  constexpr double kRadius_m = 12.0;
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < 90; ++i) {
    const double a = i * std::numbers::pi / 45.0;
    corners.emplace_back(kRadius_m * std::cos(a), kRadius_m * std::sin(a));
  }
  Random random(5, "driver");
  const VehicleMotion motion =
      drive_line(DrivingLine(corners, 1.0, true), 2, {}, small("zurich").vehicle,
                 Ground(GroundSpec{}), {.wander = false}, random);
  const double half_s = 0.5 * motion.states().back().t_s;
  for (const VehicleState& state : motion.states())
    if (std::abs(state.t_s - half_s) < 0.25 * half_s) {
      EXPECT_NEAR(std::hypot(state.x, state.y), kRadius_m, 0.03) << state.t_s;
    }
}

// The scanner reads ten times a second.
TEST(RangeStream, AScanHasEachBeamOnce) {
  const Scenario scenario = small("zurich");
  const VehicleMotion motion = drive(scenario, Ground(scenario.ground));
  const RangeModel model = nominal_range_model();
  StreamOptions options;
  options.noise = false;
  std::vector<RangeReading> readings;
  simulate_ranges(bare(scenario), motion, Pedestrians(scenario, motion, 1), model, 0, 0.35, options,
                  [&](const RangeReading& reading) { readings.push_back(reading); });
  const std::size_t beams = model.azimuth_rad.size();
  ASSERT_EQ(readings.size(), 4 * beams);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    EXPECT_EQ(readings[i].beam, static_cast<std::int64_t>(i % beams));
    EXPECT_EQ(readings[i].t_ns, static_cast<std::int64_t>(i / beams) * 100'000'000);
  }
}

}  // namespace
}  // namespace roadbook
