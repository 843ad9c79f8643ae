#include "diagnosis/range/range_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace roadbook {
namespace {

// Scans of twenty beams in a room. The expected range of a beam changes with the pose by its
// direction. The error of the reference pose is correlated over seconds.
struct Made {
  double correlation = 0.0;  // of each beam's own noise
  double by_turn = 0.0;      // of its log variance
  double pose_m = 0.02;
};

RangeReadings scans(std::uint64_t seed, const Made& made) {
  constexpr double kSigma = 0.02;
  constexpr std::size_t kBeams = 20;
  Random random(seed);
  RangeReadings readings;
  readings.max_m = 20.0;
  std::vector<double> last(kBeams, 0.0);
  for (double& l : last) l = random.normal();
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  for (int k = 0; k < 600; ++k) {
    for (double& p : pose) p = 0.95 * p + 0.31 * made.pose_m * random.normal();
    const double turn = 0.4 * (1.0 + std::sin(0.05 * k));
    for (std::size_t b = 0; b < kBeams; ++b) {
      const double a = 0.3 * static_cast<double>(b);
      ExpectedRange r;
      r.t_s = 0.1 * k;
      r.beam = b;
      r.expected_m = 6.0 + std::sin(a);
      r.yaw_rate = -turn;
      r.by_pose = {std::cos(a), std::sin(a), 3.0 * std::cos(2.0 * a)};
      last[b] = made.correlation * last[b] +
                std::sqrt(1.0 - made.correlation * made.correlation) * random.normal();
      r.read_m = r.expected_m + r.by_pose.dot(pose) +
                 kSigma * std::exp(0.5 * made.by_turn * (turn - 0.2)) * last[b];
      readings.samples.push_back(r);
    }
  }
  return readings;
}

std::vector<NoiseCause> range_noise_of(std::uint64_t seed, const Made& made) {
  const RangeReadings readings = scans(seed, made);
  return range_noise(readings, fit_mixture(readings, {}));
}

TEST(RangeNoise, AReferencePoseThatErrsForSecondsIsNoNoiseOfTheBeams) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) EXPECT_TRUE(range_noise_of(seed, {}).empty());
}

TEST(RangeNoise, CorrelationOfEachBeamIsFoundBesideIt) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto causes = range_noise_of(seed, {.correlation = 0.5});
    ASSERT_EQ(causes.size(), 1U);
    EXPECT_EQ(causes[0].effect, "range0.correlation");
    EXPECT_NEAR(causes[0].size, 0.5, 3.0 * causes[0].sigma);
  }
}

TEST(RangeNoise, VarianceThatGrowsInBendsIsFoundWithItsSize) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto causes = range_noise_of(seed, {.by_turn = 3.0, .pose_m = 0.01});
    ASSERT_EQ(causes.size(), 1U);
    EXPECT_EQ(causes[0].effect, "range0.variance(turn)");
    EXPECT_NEAR(causes[0].size, 3.0, 3.0 * causes[0].sigma);
  }
}

}  // namespace
}  // namespace roadbook
