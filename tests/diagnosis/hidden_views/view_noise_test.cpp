#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "diagnosis/numerics/smoothed_rate.hpp"
#include "diagnosis/numerics/student_noise.hpp"

namespace roadbook::test {
namespace {

// A speed with occasional changes, read at 50 Hz with noise as large as the changes.
struct NoisySpeed {
  std::vector<RateReading> readings;
  std::vector<double> truth;

  explicit NoisySpeed(std::uint64_t seed) {
    Random random(seed, "speed");
    double speed = 2.0;
    double acceleration = 0.0;
    for (int i = 0; i < 4000; ++i) {
      if (i % 50 == 0) acceleration = random.uniform(-0.8, 0.8) - 0.5 * (speed - 2.0);
      speed += 0.02 * acceleration;
      truth.push_back(speed);
      readings.push_back({20'000'000LL * i, speed + 0.03 * random.normal(), 1.0});
    }
  }
};

// Regression calibration: a regression of the truth on the smoothed changes has slope 1; on raw
// changes the slope decreases with the noise.
TEST(SmoothedRate, TruthRegressedOnItHasSlopeOne) {
  double xy = 0.0, xx = 0.0, raw_xy = 0.0, raw_xx = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const NoisySpeed drive(seed);
    const SmoothedRate smoothed(drive.readings);
    for (std::size_t i = 100; i + 5 < drive.truth.size(); i += 5) {
      const double change = drive.truth[i + 5] - drive.truth[i];
      const double x =
          smoothed.at(drive.readings[i + 5].t_ns)[0] - smoothed.at(drive.readings[i].t_ns)[0];
      const double raw = drive.readings[i + 5].rate - drive.readings[i].rate;
      xy += x * change;
      xx += x * x;
      raw_xy += raw * change;
      raw_xx += raw * raw;
    }
  }
  EXPECT_NEAR(xy / xx, 1.0, 0.03);
  EXPECT_LT(raw_xy / raw_xx, 0.8);
}

TEST(SmoothedRate, ItsSecondPartIsTheDerivativeOfItsFirst) {
  const NoisySpeed drive(9);
  const SmoothedRate smoothed(drive.readings);
  for (const std::int64_t t : {10'000'000'000LL, 33'330'000'000LL, 60'010'000'000LL}) {
    const double slope = (smoothed.at(t + 40'000'000)[0] - smoothed.at(t - 40'000'000)[0]) / 0.08;
    EXPECT_NEAR(smoothed.at(t)[1], slope, 0.05);
  }
}

std::vector<double> student_squares(double freedom, double sigma, std::uint64_t seed) {
  Random random(seed, "student");
  std::vector<double> squares;
  for (int i = 0; i < 20000; ++i) {
    // Two normals over the root of a gamma: exact for whole halves of the freedom.
    double gamma = 0.0;
    for (int k = 0; k < static_cast<int>(freedom); ++k) gamma += std::pow(random.normal(), 2);
    const double scale = freedom < 1e5 ? freedom / gamma : 1.0;
    squares.push_back(sigma * sigma * scale *
                      (std::pow(random.normal(), 2) + std::pow(random.normal(), 2)));
  }
  return squares;
}

TEST(StudentNoise, FindsScaleAndTails) {
  const StudentNoise heavy = student_noise(student_squares(3.0, 0.4, 1));
  EXPECT_EQ(heavy.freedom, 3.0);
  EXPECT_NEAR(heavy.sigma, 0.4, 0.01);
  Random random(2, "normal");
  std::vector<double> squares;
  for (int i = 0; i < 20000; ++i)
    squares.push_back(0.09 * (std::pow(random.normal(), 2) + std::pow(random.normal(), 2)));
  const StudentNoise normal = student_noise(squares);
  EXPECT_EQ(normal.freedom, kNormalFreedom);
  EXPECT_NEAR(normal.sigma, 0.3, 0.005);
}

// Fewer than one wrong match in ten about the nominal place moves a weighted mean by far less than
// a plain one.
TEST(StudentNoise, WrongMatchesAboutTheNominalPlaceHardlyPullASize) {
  Random random(3, "matches");
  const double size = 2.0;
  std::vector<double> x, squares;
  for (int i = 0; i < 20000; ++i) {
    const bool wrong = random.uniform() < 0.08;
    x.push_back(wrong ? 2.5 * random.uniform(-1.0, 1.0) : size + 0.3 * random.normal());
    squares.push_back(std::pow(x.back() - size, 2) + std::pow(0.3 * random.normal(), 2));
  }
  const StudentNoise noise = student_noise(squares);
  double sum = 0.0, weights = 0.0, plain = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double w = student_weight(squares[i] / (noise.sigma * noise.sigma), noise.freedom);
    sum += w * x[i];
    weights += w;
    plain += x[i] / static_cast<double>(x.size());
  }
  EXPECT_LT(plain, 0.93 * size);
  EXPECT_GT(sum / weights, 0.985 * size);
}

}  // namespace
}  // namespace roadbook::test
