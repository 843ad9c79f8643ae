#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "speedmap/speeds/lane_speeds.hpp"

namespace roadbook {
namespace {

TEST(Speed, FallsLinearlyFromTheLargestToTheSmallest) {
  EXPECT_EQ(recommended_speed(0.0, 1.0, 9.0), 9.0);
  EXPECT_EQ(recommended_speed(1.0, 1.0, 9.0), 1.0);
  EXPECT_EQ(recommended_speed(0.25, 1.0, 9.0), 7.0);
  EXPECT_EQ(recommended_speed(1.7, 1.0, 9.0), 1.0);
  double before = 10.0;
  for (double p = 0.0; p <= 1.0; p += 0.01) {
    EXPECT_LT(recommended_speed(p, 1.0, 9.0), before);
    before = recommended_speed(p, 1.0, 9.0);
  }
}

// Steps, ramps and noise.
SpeedCeiling random_ceiling(Random& random, bool closed) {
  SpeedCeiling ceiling;
  ceiling.step_m = random.uniform(0.1, 0.5);
  ceiling.closed = closed;
  const int n = 100 + static_cast<int>(random.below(400));
  double v = random.uniform(1.0, 12.0);
  double slope = 0.0;
  const bool noisy = random.uniform() < 0.3;
  for (int i = 0; i < n; ++i) {
    if (random.uniform() < 0.03) v = random.uniform(0.5, 12.0);
    if (random.uniform() < 0.05) slope = random.uniform(-0.3, 0.3);
    v = std::clamp(v + slope, 0.5, 12.0);
    ceiling.speed.push_back(noisy ? v * random.uniform(0.8, 1.0) : v);
  }
  return ceiling;
}

TEST(Speed, AProfileNeverLeavesItsLimits) {
  const MotionLimits limits{1.0, 1.5, 1.5, 1.2};
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed, "profile");
    const SpeedCeiling ceiling = random_ceiling(random, seed % 2 == 0);
    const auto speed = feasible_speeds(ceiling, limits);
    ASSERT_EQ(speed.size(), ceiling.speed.size());
    for (std::size_t i = 0; i < speed.size(); ++i) {
      ASSERT_LE(speed[i], ceiling.speed[i] * (1.0 + 1e-12));
      ASSERT_GT(speed[i], 0.0);
    }
    const ProfileDemand demand = demand_of(speed, ceiling.step_m, ceiling.closed);
    EXPECT_LE(demand.acceleration, limits.acceleration * (1.0 + 1e-9));
    EXPECT_LE(demand.braking, limits.braking * (1.0 + 1e-9));
    EXPECT_LE(demand.jerk, limits.jerk * (1.0 + 1e-6));
  }
}

TEST(Speed, SlipperyStretchesAreNotBrakedOnHard) {
  const MotionLimits limits{1.0, 1.5, 1.5, 1.2};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed, "slippery");
    SpeedCeiling ceiling = random_ceiling(random, false);
    ceiling.grip_acceleration.assign(ceiling.speed.size(), 5.0);
    const std::size_t from = ceiling.speed.size() / 3;
    for (std::size_t i = from; i < from + 60 && i < ceiling.speed.size(); ++i)
      ceiling.grip_acceleration[i] = 0.3;
    const auto speed = feasible_speeds(ceiling, limits);
    for (std::size_t i = 0; i + 1 < speed.size(); ++i) {
      const double a = (speed[i + 1] * speed[i + 1] - speed[i] * speed[i]) / (2.0 * ceiling.step_m);
      const double grip = std::min(ceiling.grip_acceleration[i], ceiling.grip_acceleration[i + 1]);
      EXPECT_LE(std::abs(a), std::min(1.5, grip) * (1.0 + 1e-9)) << seed << " at " << i;
    }
  }
}

TEST(Speed, AConstantCeilingIsDrivenAndAStopIsBrakedForInTime) {
  const MotionLimits limits{1.0, 1.5, 1.5, 1.2};
  SpeedCeiling ceiling;
  ceiling.step_m = 0.1;
  ceiling.speed.assign(1000, 8.0);
  for (const double v : feasible_speeds(ceiling, limits)) EXPECT_NEAR(v, 8.0, 1e-9);
  for (std::size_t i = 600; i < 1000; ++i) ceiling.speed[i] = 2.0;
  const auto speed = feasible_speeds(ceiling, limits);
  // Braking from 8 to 2 m/s with jerk ramps at both ends takes (8 - 2) / 1.5 + 1.5 / 1.2 = 5.25 s
  // at 5 m/s in the mean; the profile may begin earlier, but not by half as much again.
  const double way = 5.25 * 5.0;
  double begin = 0.0;
  for (std::size_t i = 0; i < speed.size(); ++i)
    if (speed[i] > 8.0 - 1e-6) begin = 0.1 * static_cast<double>(i);
  EXPECT_LE(60.0 - begin, 1.5 * way);
  EXPECT_GE(60.0 - begin, 0.99 * way);
}

TEST(Speed, BadCeilingsAndLimitsAreRefused) {
  const auto refuse = [](const SpeedCeiling& ceiling, const MotionLimits& limits = {}) {
    EXPECT_THROW((void)feasible_speeds(ceiling, limits), InvalidOption);
  };
  refuse({0.25, false, {}, {}});
  refuse({0.0, false, {1.0}, {}});
  refuse({0.25, false, {1.0, NAN}, {}});
  refuse({0.25, false, {1.0, 0.0}, {}});
  refuse({0.25, false, {1.0, 2.0}, {1.0}});
  refuse({0.25, false, {1.0, 2.0}, {}}, {-1.0});
  LaneSpeedOptions options;
  options.max_speed = 0.5;
  EXPECT_THROW(options.check(), InvalidOption);
}

TEST(Speed, GripLimitsBendsAndStopping) {
  LaneSpeedOptions options;
  options.grip_share = 1.0;
  options.reaction_s = 0.0;
  options.sight_m = 20.0;
  // v^2 = 2 mu g d and v^2 = mu g / kappa.
  EXPECT_NEAR(grip_speed(0.5, 0.0, options), std::sqrt(2.0 * 0.5 * 9.81 * 20.0), 1e-12);
  EXPECT_NEAR(grip_speed(0.5, -0.2, options), std::sqrt(0.5 * 9.81 / 0.2), 1e-12);
  options.reaction_s = 1.0;
  const double v = grip_speed(0.5, 0.0, options);
  EXPECT_NEAR(v * 1.0 + v * v / (2.0 * 0.5 * 9.81), 20.0, 1e-9);
}

PathCurve straight(double length) {
  std::vector<Eigen::Vector3d> points;
  for (double x = 0.0; x <= length; x += 1.0) points.emplace_back(x, 0.0, 0.0);
  PathFitOptions options;
  options.segments = 8;
  return PathCurve(fit_path(points, options).path);
}

TEST(Speed, ALanesSpeedIsTheLowestOfLawPeopleAndGripUnderTheVehicle) {
  const PathCurve curve = straight(80.0);
  LaneSpeedOptions options;
  const auto s = even_places(curve, options.step_m);
  const PresenceAt presence = [](const Eigen::Vector2d& p) -> std::optional<PresenceValue> {
    // A person is 0.8 m from the line at x = 30. Beyond x = 60, the presence of people is unknown.
    if (p.x() > 60.0) return std::nullopt;
    return PresenceValue{(p - Eigen::Vector2d(30.0, 0.9)).norm() < 0.3 ? 0.9 : 0.1, 0.01};
  };
  const FrictionAt friction = [](double at, double) -> std::optional<PropertyMoments> {
    if (at < 45.0) return std::nullopt;
    return PropertyMoments{0.2, 1e-4};
  };
  const auto places = speed_limits_along(way_points(curve, s), s, 7.0, presence, friction, options);
  for (const LaneSpeed& place : places) {
    EXPECT_LE(place.speed, 7.0);
    if (std::abs(place.s_m - 30.0) < 0.1) {
      EXPECT_NEAR(place.speed, recommended_speed(0.9, options.min_speed, options.max_speed), 1e-9);
    }
    if (place.s_m > 46.0) {
      EXPECT_NEAR(place.grip, grip_speed(0.2 - 1.6449 * 0.01, 0.0, options), 1e-3);
    }
    if (place.s_m > 60.5) {
      EXPECT_TRUE(std::isinf(place.pedestrian));
    }
    if (place.s_m < 20.0) {
      EXPECT_EQ(place.speed, 7.0) << "the limit";
    }
  }
  options.caution = 2.0;
  const auto careful = speed_limits_along(way_points(curve, s), s, 7.0, presence, {}, options);
  EXPECT_LT(careful.front().pedestrian, places.front().pedestrian);
}

TEST(Speed, LanesThatMeetAgreeOnOneSpeed) {
  const auto lane = [](std::uint64_t id, int from, int to, double v) {
    LaneProfile profile{id, 0.25, false, from, to, std::vector<LaneSpeed>(200)};
    for (LaneSpeed& place : profile.places) {
      place.speed = v;
      place.grip_acceleration = INFINITY;
    }
    return profile;
  };
  std::vector<LaneProfile> profiles{lane(1, -1, 0, 8.0), lane(2, 0, 1, 3.0), lane(3, 1, -1, 6.0)};
  LaneSpeedOptions options;
  for (LaneProfile& profile : profiles) make_feasible(profile.places, 0.25, false, options);
  agree_at_intersections(profiles, options);
  EXPECT_NEAR(profiles[0].places.back().speed, profiles[1].places.front().speed, 1e-6);
  EXPECT_NEAR(profiles[1].places.back().speed, profiles[2].places.front().speed, 1e-6);
  EXPECT_NEAR(profiles[0].places.front().speed, 8.0, 1e-6);
}

}  // namespace
}  // namespace roadbook
