#include "diagnosis/simulated_again.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/planar_car.hpp"

namespace roadbook {
namespace {

std::vector<double> normal_sample(std::size_t size, double mean, double sigma, unsigned seed) {
  std::mt19937 draw(seed);
  std::normal_distribution<double> normal(mean, sigma);
  std::vector<double> sample(size);
  for (double& v : sample) v = normal(draw);
  return sample;
}

// Normal distributions a shift d apart differ by 2 Phi(d / 2) - 1 at most: 0.383 for d = 1.
TEST(SampleDifference, IsThatOfShiftedNormalsByHand) {
  const auto first = normal_sample(4000, 0.0, 1.0, 1);
  const SampleDifference same = compare_samples(first, normal_sample(4000, 0.0, 1.0, 2));
  EXPECT_LT(same.distance, 0.04);
  EXPECT_GT(same.p, 0.01);
  const SampleDifference moved = compare_samples(first, normal_sample(4000, 1.0, 1.0, 3));
  EXPECT_NEAR(moved.distance, std::erf(0.5 / std::sqrt(2.0)), 0.03);
  EXPECT_LT(moved.p, 1e-6);
  EXPECT_NEAR(moved.second.mean, 1.0, 0.05);
  EXPECT_NEAR(moved.second.sigma, 1.0, 0.05);
  for (const auto& [x, y] : moved.quantiles) EXPECT_NEAR(y - x, 1.0, 0.25);
}

// P-values of samples of one distribution are uniform; those of correlated values are not too
// small.
TEST(SampleDifference, HasUniformProbabilitiesWhereNothingDiffers) {
  for (const double correlation : {0.0, 0.8}) {
    int below = 0;
    for (unsigned seed = 0; seed < 400; ++seed) {
      const auto series = [&](unsigned of) {
        auto values = normal_sample(600, 0.0, 1.0, 1000 * of + seed);
        for (std::size_t i = 1; i < values.size(); ++i) values[i] += correlation * values[i - 1];
        return values;
      };
      below += compare_samples(series(1), series(2)).p < 0.1 ? 1 : 0;
    }
    if (correlation == 0.0) {
      EXPECT_GT(below, 12);
    }
    EXPECT_LT(below, 64) << correlation;
  }
}

const StreamComparison* stream(const Diagnosis& d, const std::string& name) {
  const auto found = std::find_if(d.simulated.begin(), d.simulated.end(),
                                  [&](const StreamComparison& c) { return c.stream == name; });
  return found == d.simulated.end() ? nullptr : &*found;
}

// A car that an independent program drives, with a bias that the stated model does not have.
TEST(SimulatedAgain, ShowsABiasAndThatTheExtendedModelHasIt) {
  MotionStreams streams = test::PlanarCar(11).record({});
  for (GyroSample& g : streams.gyro) g.rate_rad_s += 0.01;
  DiagnosisOptions options;
  options.compare = true;
  const Diagnosis d = diagnose(streams, "drive", options);
  const StreamComparison* gyro = stream(d, "imu0");
  ASSERT_NE(gyro, nullptr);
  ASSERT_TRUE(gyro->extended);
  EXPECT_EQ(gyro->unit, "deg/s");
  EXPECT_NEAR(gyro->recorded.mean, 0.573, 0.06);
  EXPECT_NEAR(gyro->stated.second.mean, 0.0, 0.06);
  EXPECT_NEAR(gyro->extended->second.mean, 0.573, 0.06);
  EXPECT_GT(gyro->stated.distance, 0.5);
  EXPECT_LT(gyro->extended->distance, 0.12);
  // The noise of the fit is on the safe side.
  EXPECT_GT(gyro->extended->second.sigma, 0.9 * gyro->recorded.sigma);
  EXPECT_LT(gyro->extended->second.sigma, 1.4 * gyro->recorded.sigma);
  const StreamComparison* reckoned = stream(d, "dead reckoning");
  ASSERT_NE(reckoned, nullptr);
  EXPECT_NEAR(reckoned->recorded.mean, reckoned->extended->second.mean,
              0.3 * reckoned->recorded.mean);
  EXPECT_LT(reckoned->stated.second.mean, 0.5 * reckoned->recorded.mean);
}

// Poses off by decimetres for a second: the comparison still shows which sensor errs.
TEST(SimulatedAgain, ShowsTheGyrosBiasAgainstPosesThatSlideSideways) {
  MotionStreams streams = test::PlanarCar(13).record({});
  for (GyroSample& g : streams.gyro) g.rate_rad_s += 0.01;
  std::mt19937 draw(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  const double keep = std::exp(-0.1);
  double x = 0.25 * normal(draw), y = 0.25 * normal(draw);
  for (PoseSample& pose : streams.poses) {
    x = keep * x + 0.25 * std::sqrt(1.0 - keep * keep) * normal(draw);
    y = keep * y + 0.25 * std::sqrt(1.0 - keep * keep) * normal(draw);
    pose.x += x;
    pose.y += y;
  }
  DiagnosisOptions options;
  options.compare = true;
  const Diagnosis d = diagnose(streams, "drive", options);
  for (const StreamComparison& c : d.simulated) {
    if (c.channel == "yaw_rate") {
      EXPECT_NEAR(c.recorded.mean, 0.573, 0.1);
    }
    if (c.channel == "heading" && c.stream == "wheels0") {
      EXPECT_NEAR(c.recorded.mean, 0.0, 0.1);
    }
  }
}

TEST(SimulatedAgain, OfASoundCarIsTheSameDistributionAndTheSameBytesTwice) {
  const MotionStreams streams = test::PlanarCar(12).record({});
  DiagnosisOptions options;
  options.compare = true;
  const Diagnosis d = diagnose(streams, "drive", options);
  ASSERT_GE(d.simulated.size(), 6U);
  for (const StreamComparison& c : d.simulated) {
    EXPECT_FALSE(c.extended) << c.stream;
    if (c.stream == "dead reckoning") {
      // The noise of the fit is on the safe side.
      EXPECT_GT(c.stated.second.mean, 0.8 * c.recorded.mean);
      EXPECT_LT(c.stated.second.mean, 2.0 * c.recorded.mean);
      continue;
    }
    EXPECT_LT(c.stated.distance, 0.2) << c.stream << ' ' << c.channel;
  }
  const Observations obs = observe(streams);
  const MotionNoise noise;
  const Observations a = simulated_again(obs, {}, noise, 1), b = simulated_again(obs, {}, noise, 1);
  for (std::size_t i = 0; i < obs.gyro.size(); ++i) ASSERT_EQ(a.gyro[i].value, b.gyro[i].value);
  EXPECT_NE(a.gyro[5].value, simulated_again(obs, {}, noise, 2).gyro[5].value);
}

}  // namespace
}  // namespace roadbook
