#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "mapping/optimisation/graph_relaxation.hpp"

namespace roadbook {
namespace {

constexpr int kLap = 120;    // poses of a lap
constexpr int kOverlap = 2;  // poses of the second lap
constexpr double kRingRadius = 20.0;
constexpr double kLoopScaleSigma = 0.002;

Matrix6d isotropic_information(double sigma_m, double sigma_rad) {
  Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return diagonal.asDiagonal();
}

// A circle driven once and a bit more by a camera whose unit changes by exp(`drift`) along the way,
// the same share at each step. All motions are exact.
struct DriftingRing {
  std::vector<Eigen::Isometry3d> truth;
  std::vector<double> log_scales;
  PoseGraph graph;
};

RelativePose measured(const DriftingRing& ring, int from, int to, double log_scale_sigma) {
  const auto a = static_cast<std::size_t>(from);
  const auto b = static_cast<std::size_t>(to);
  RelativePose edge{from, to, ring.truth[a].inverse() * ring.truth[b],
                    isotropic_information(0.001, 0.0002)};
  edge.T_from_to.translation() /= std::exp(ring.log_scales[a]);
  edge.log_scale_sigma = log_scale_sigma;
  return edge;
}

DriftingRing drive_ring(double drift) {
  DriftingRing ring;
  const int count = kLap + kOverlap;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kLap;
    ring.truth.push_back(pose_from_planar(kRingRadius * std::sin(angle),
                                          kRingRadius * (1.0 - std::cos(angle)), angle));
    ring.log_scales.push_back(drift * i / (count - 1));
  }
  ring.graph.pose_scales.resize(static_cast<std::size_t>(count));
  ring.graph.pose_scales.front().fixed = true;
  ring.graph.T_map_vehicle = {ring.truth.front()};
  for (int i = 0; i + 1 < count; ++i) {
    ring.graph.odometry.push_back(measured(ring, i, i + 1, 0.01));
    ring.graph.T_map_vehicle.push_back(ring.graph.T_map_vehicle.back() *
                                       ring.graph.odometry.back().T_from_to);
  }
  for (int i = kLap; i < count; ++i) {
    ring.graph.loops.push_back(measured(ring, i - kLap, i, kLoopScaleSigma));
    ring.graph.loops.back().log_scale = ring.log_scales[static_cast<std::size_t>(i)] -
                                        ring.log_scales[static_cast<std::size_t>(i - kLap)];
  }
  return ring;
}

double largest_error_m(const DriftingRing& ring, const PoseGraphResult& result) {
  double largest = 0.0;
  for (std::size_t i = 0; i < ring.truth.size(); ++i)
    largest = std::max(
        largest, (ring.truth[i].translation() - result.T_map_vehicle[i].translation()).norm());
  return largest;
}

TEST(ScaledGraph, LoopsRemoveADriftOfTheScaleOfEitherSign) {
  Random random(7);
  for (int trial = 0; trial < 8; ++trial) {
    const double drift = (trial % 2 == 0 ? 1.0 : -1.0) * random.uniform(0.1, 0.7);
    SCOPED_TRACE(::testing::Message() << "drift " << drift);
    const DriftingRing ring = drive_ring(drift);
    PoseGraphOptions options;
    options.robust = false;  // two loops have one vote
    const PoseGraphResult result = relax(ring.graph, options);
    ASSERT_TRUE(result.usable) << result.message;
    for (std::size_t i = 0; i < ring.log_scales.size(); ++i)
      EXPECT_NEAR(result.log_scales[i], ring.log_scales[i], 0.03);
    // Rigid motions cannot do this: they reject the loops or bend the ring.
    PoseGraph rigid = ring.graph;
    rigid.pose_scales.clear();
    EXPECT_LT(largest_error_m(ring, result), 0.1 * largest_error_m(ring, relax(rigid, options)));
  }
}

TEST(ScaledGraph, ALoopWhoseScaleContradictsTheOthersIsRejected) {
  DriftingRing ring = drive_ring(0.4);
  RelativePose wrong = ring.graph.loops[0];
  wrong.log_scale += 0.3;  // its pose is right
  ring.graph.loops.push_back(wrong);
  const PoseGraphResult result = relax(ring.graph);
  ASSERT_TRUE(result.usable) << result.message;
  for (std::size_t k = 0; k + 1 < result.loop_accepted.size(); ++k)
    EXPECT_TRUE(result.loop_accepted[k]) << k;
  EXPECT_FALSE(result.loop_accepted.back());
  EXPECT_LT(largest_error_m(ring, result), 0.05);
}

TEST(ScaledGraph, HeightsAlongTheWayGiveTheScaleAndAFalseOneDoesNot) {
  DriftingRing ring = drive_ring(-0.5);
  ring.graph.loops.clear();
  for (std::size_t i = 0; i < ring.log_scales.size(); i += 12) {
    PoseScale& scale = ring.graph.pose_scales[i];
    scale.prior = ring.log_scales[i] + (i == 60 ? 0.6 : 0.0);  // a parked car taken for the ground
    scale.prior_sigma = 0.03;
  }
  const PoseGraphResult result = relax(ring.graph);
  ASSERT_TRUE(result.usable) << result.message;
  for (std::size_t i = 0; i <= 120; ++i)  // up to the last height
    EXPECT_NEAR(result.log_scales[i], ring.log_scales[i], 0.08) << i;
}

}  // namespace
}  // namespace roadbook
