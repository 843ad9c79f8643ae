#include "diagnosis/pose_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr double kPush = 1.5;  // [m/s^2]: the most of an acceleration that swings
constexpr double kSwing = 2.0 * std::numbers::pi / 2.0;  // [rad/s]

double pushed(double t) { return kPush * std::sin(kSwing * t); }

// Along a line that is oblique to the axes, in closed form; poses at 12.5 Hz.
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
  double rms = 0.0;    ///< beside that share [m/s^2]
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

// What depends on an acceleration comes out too large by as much as that is blurred.
TEST(PoseMotion, ExactPosesTellAnAccelerationThatChanges) {
  EXPECT_GT(told(0.0).share, 0.95);
  EXPECT_LT(told(0.0).share, 1.0);
}

TEST(PoseMotion, PosesThatScatterAreSmoothedForAsLongAsThatTakes) {
  for (const double scatter : {0.002, 0.005, 0.02}) EXPECT_LT(told(scatter).rms, 0.1) << scatter;
  EXPECT_NEAR(half_window_of(swinging_drive(0.02)), 0.7, 0.05);
  EXPECT_LT(half_window_of(swinging_drive(0.005)), 0.5);
}

}  // namespace
}  // namespace roadbook
