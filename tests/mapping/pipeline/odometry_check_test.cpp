#include "mapping/loops/odometry_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "base/se3.hpp"

namespace roadbook {
namespace {

constexpr int kLap = 300;  // motions of 0.2 m
constexpr double kStorey = 2.8;

// Two laps of a ring of 60 m. A ramp in the second half of the first lap rises by `rise`. In
// height, roll and pitch, the odometry errs by less than its discounted information states.
std::vector<VoKeyframe> two_laps(double rise, std::uint64_t seed) {
  Vector6d sigma;
  sigma << 0.0045, 0.0017, 0.013, 0.0085, 0.0076, 0.0014;
  const auto ring = [&](int k) {
    const double angle = 2.0 * M_PI * k / kLap;
    const double ramp = std::clamp((k - 0.5 * kLap) / (0.25 * kLap), 0.0, 1.0);
    const double radius = 0.2 * kLap / (2.0 * M_PI);
    Eigen::Isometry3d T =
        pose_from_planar(radius * std::cos(angle), radius * std::sin(angle), angle + 0.5 * M_PI);
    T.translation().z() = rise * ramp;
    return T;
  };
  Random random(seed, "odometry");
  std::vector<VoKeyframe> keyframes;
  for (int k = 0; k < 2 * kLap; ++k) {
    VoKeyframe keyframe;
    keyframe.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
    if (k > 0) {
      Vector6d error;
      for (int i = 0; i < 6; ++i)
        error[i] = random.normal(0.0, sigma[i] * (i > 1 && i < 5 ? 0.15 : 1.0));
      keyframe.T_odom_vehicle =
          keyframes.back().T_odom_vehicle * (ring(k - 1).inverse() * ring(k)) * se3_exp(error);
    }
    keyframes.push_back(keyframe);
  }
  return keyframes;
}

// Loops that join places of the second lap with those of the first lap, up to the end of the
// ramp.
std::vector<LoopEdge> loops_between_laps() {
  std::vector<LoopEdge> edges;
  for (int k = kLap; k < kLap + 215; k += 4) {
    LoopEdge edge;
    edge.from = k - kLap;
    edge.to = k;
    edge.information = 1e4 * Matrix6d::Identity();
    edges.push_back(edge);
  }
  return edges;
}

// Number of loops that stay.
int accepted_of(const std::vector<VoKeyframe>& keyframes, std::vector<int> stretch) {
  const auto edges = loops_between_laps();
  stretch.resize(edges.size(), 0);
  const auto contradicts = contradict_odometry(keyframes, edges, stretch);
  return static_cast<int>(std::count(contradicts.begin(), contradicts.end(), 0));
}

TEST(OdometryCheck, RevisitsStayAndAnEqualStoreyGoes) {
  const int all = static_cast<int>(loops_between_laps().size());
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    EXPECT_EQ(accepted_of(two_laps(0.0, seed), {}), all);
    EXPECT_EQ(accepted_of(two_laps(kStorey, seed), {}), 0);
  }
}

// Loops that begin on the ramp differ from the odometry by less than a storey: alone they would
// stay, in their stretch they go.
TEST(OdometryCheck, AStretchIsJudgedAsAWhole) {
  std::vector<int> alone(loops_between_laps().size());
  for (std::size_t i = 0; i < alone.size(); ++i) alone[i] = static_cast<int>(i);
  EXPECT_GT(accepted_of(two_laps(kStorey, 1), alone), 0);
  EXPECT_EQ(accepted_of(two_laps(kStorey, 1), {}), 0);
}

TEST(OdometryCheck, LoopsAcrossAGapAreNotJudged) {
  std::vector<VoKeyframe> keyframes = two_laps(kStorey, 1);
  keyframes[kLap - 1].after_gap = true;
  EXPECT_EQ(accepted_of(keyframes, {}), static_cast<int>(loops_between_laps().size()));
}

// Twenty laps whose odometry leans over by 0.03 rad a lap: each lap agrees with the last one, and
// with the first one over those between. The way of all laps at once has its errors repeat.
TEST(OdometryCheck, LoopsToTheFirstOfManyLapsStay) {
  constexpr int kLaps = 20;
  constexpr double kLean = 1e-4;  // of each motion [rad]
  std::vector<VoKeyframe> keyframes;
  for (int lap = 0; lap < kLaps; ++lap) {
    const auto two = two_laps(0.0, 100 + static_cast<std::uint64_t>(lap));
    for (std::size_t k = 0; k < kLap; ++k) {
      VoKeyframe next = two[k + kLap];
      if (!keyframes.empty())
        next.T_odom_vehicle = keyframes.back().T_odom_vehicle *
                              two[k + kLap - 1].T_odom_vehicle.inverse() * next.T_odom_vehicle;
      keyframes.push_back(next);
    }
  }
  for (int k = 0; k < kLaps * kLap; ++k) {
    Eigen::Isometry3d& T = keyframes[static_cast<std::size_t>(k)].T_odom_vehicle;
    T = Eigen::AngleAxisd(kLean * k, Eigen::Vector3d::UnitX()) * T;
  }
  std::vector<LoopEdge> edges;
  std::vector<int> stretch;
  for (int lap = 1; lap < kLaps; ++lap)
    for (const int to_lap : {0, lap - 1})
      for (int k = 0; k < kLap; k += 10) {
        LoopEdge edge;
        edge.from = to_lap * kLap + k;
        edge.to = lap * kLap + k;
        edge.information = 1e4 * Matrix6d::Identity();
        edges.push_back(edge);
        stretch.push_back(2 * lap + (to_lap == 0 ? 0 : 1));
      }
  const auto contradicts = contradict_odometry(keyframes, edges, stretch);
  EXPECT_EQ(std::count(contradicts.begin(), contradicts.end(), 1), 0);
}

}  // namespace
}  // namespace roadbook
