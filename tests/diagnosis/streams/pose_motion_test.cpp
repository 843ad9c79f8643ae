#include "diagnosis/streams/pose_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "diagnosis/friction/friction_readings.hpp"

namespace roadbook {
namespace {

constexpr double kPush = 1.5;  // [m/s^2]: the most of an acceleration that swings
constexpr double kSwing = 2.0 * std::numbers::pi / 2.0;  // [rad/s]

double pushed(double t) { return kPush * std::sin(kSwing * t); }

// Along a line oblique to the axes, in closed form; poses at 12.5 Hz.
std::vector<PoseSample> swinging_drive(double scatter_m) {
  Random random(3, "swinging drive");
  std::vector<PoseSample> poses;
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.08 * k;
    const double way =
        (4.0 + kPush / kSwing) * t - kPush / (kSwing * kSwing) * std::sin(kSwing * t);
    poses.push_back({t, way * std::cos(0.4) + scatter_m * random.normal(),
                     way * std::sin(0.4) + scatter_m * random.normal(), 0.4});
  }
  return poses;
}

struct Told {
  double share = 0.0;  ///< of the acceleration
  double rms = 0.0;    ///< of the remainder [m/s^2]
};

Told told(double scatter_m) {
  const std::vector<PoseSample> poses = swinging_drive(scatter_m);
  PoseSmoother smoother(poses, half_window_of(poses));
  double products = 0.0, squares = 0.0, count = 0.0;
  std::vector<std::pair<double, double>> pairs;
  for (double t = 2.0; t < 78.0; t += 0.05) {
    pairs.emplace_back(pushed(t), smoother.at(t)->acceleration);
    products += pairs.back().first * pairs.back().second;
    squares += pairs.back().first * pairs.back().first;
    count += 1.0;
  }
  Told result{products / squares, 0.0};
  for (const auto& [true_one, one] : pairs)
    result.rms += std::pow(one - result.share * true_one, 2) / count;
  result.rms = std::sqrt(result.rms);
  return result;
}

// Blurred accelerations make effects of acceleration too large by the same factor.
TEST(PoseMotion, ExactPosesTellAnAccelerationThatChanges) {
  EXPECT_GT(told(0.0).share, 0.95);
  EXPECT_LT(told(0.0).share, 1.0);
}

TEST(PoseMotion, PosesThatScatterAreSmoothedForAsLongAsThatTakes) {
  for (const double scatter : {0.002, 0.005, 0.02}) EXPECT_LT(told(scatter).rms, 0.1) << scatter;
  EXPECT_NEAR(half_window_of(swinging_drive(0.02)), 0.7, 0.05);
  EXPECT_LT(half_window_of(swinging_drive(0.005)), 0.5);
}

// Repeated poses of a standing car, or one exact axis, do not make a receiver exact.
TEST(PoseMotion, TheAxisThatScattersOfTheCarThatMovesCounts) {
  std::vector<PoseSample> stands = swinging_drive(0.02);
  for (std::size_t i = 0; i < 600; ++i) {
    stands[i].x = stands[600].x;
    stands[i].y = stands[600].y;
  }
  EXPECT_NEAR(half_window_of(stands), 0.7, 0.05);
  std::vector<PoseSample> one_axis = swinging_drive(0.02);
  const std::vector<PoseSample> exact = swinging_drive(0.0);
  for (std::size_t i = 0; i < exact.size(); ++i) one_axis[i].y = exact[i].y;
  EXPECT_NEAR(half_window_of(one_axis), 0.7, 0.05);
}

// Exact poses with a third missing at random: readings between them are kept.
TEST(PoseMotion, WherePosesAreMissingReadingsAreKept) {
  Random random(4, "missing poses");
  std::vector<PoseSample> poses = swinging_drive(0.0);
  std::erase_if(poses, [&](const PoseSample&) { return random.uniform() < 0.33; });
  std::vector<RawFriction> raw(1500);
  for (std::size_t i = 0; i < raw.size(); ++i) {
    raw[i].t_s = 1.0 + 0.05 * static_cast<double>(i);
    raw[i].friction = 0.8;
    raw[i].sigma = 0.05;
  }
  EXPECT_GT(friction_readings(poses, raw).samples.size(), 1490U);
}

}  // namespace
}  // namespace roadbook
