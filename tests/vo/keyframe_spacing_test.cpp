#include "vo/keyframe_spacing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "base/random.hpp"
#include "drive/writer.hpp"
#include "tests/drive/drive_fixture.hpp"
#include "tests/support/fisheye_rig.hpp"
#include "vo/track_drive.hpp"

// Which frames of a drive with wheels become keyframes. Its images are blank: where they show
// nothing the motion is the wheels', and the choice is made before any image is read.

namespace roadbook {
namespace {

constexpr std::int64_t kStart_ns = 1'400'000'000'000'000'000;
constexpr double kSpacing_m = 0.20;

/// Distance of the car along its path at the frames of a drive.
struct DrivenFrames {
  std::vector<double> t_s;
  std::vector<double> s_m;
  double turn_radius_m = 0.0;  ///< of a circle to the left; 0: straight on
};

// Steps of equal length at equal times.
DrivenFrames steady(double step_m, double interval_s, int frames) {
  DrivenFrames drive;
  for (int i = 0; i < frames; ++i) {
    drive.t_s.push_back(i * interval_s);
    drive.s_m.push_back(i * step_m);
  }
  return drive;
}

Rig small_rig() {
  Rig rig = test::fisheye_rig(1);
  rig.cameras[0].camera = rig.cameras[0].camera.scaled(0.25);
  return rig;
}

// Frames that become keyframes.
std::vector<std::size_t> keyframes_of(const DrivenFrames& driven) {
  const test::TemporaryFolder folder;
  const WheelModel model;
  const Rig rig = small_rig();
  const auto& camera = rig.cameras[0].camera;
  DriveWriter writer(folder.path() / "drive", rig, model);
  for (std::size_t i = 0; i < driven.t_s.size(); ++i) {
    const auto t_ns = kStart_ns + std::llround(driven.t_s[i] * 1e9);
    const double outer =
        driven.turn_radius_m > 0.0 ? 0.5 * model.track_width_m / driven.turn_radius_m : 0.0;
    writer.write_image(0, t_ns, cv::Mat(camera.height, camera.width, CV_8U, cv::Scalar(90)));
    writer.write_wheels({t_ns, driven.s_m[i] * (1.0 - outer) / model.radius_left_m,
                         driven.s_m[i] * (1.0 + outer) / model.radius_right_m, std::nullopt});
  }
  writer.finish();
  const auto odometry = track_drive(Drive::open(folder.path() / "drive"), {cv::Mat()}, {});
  std::vector<std::size_t> frames;
  for (const VoKeyframe& keyframe : odometry.keyframes) frames.push_back(keyframe.frame);
  return frames;
}

std::vector<double> gaps_of(const DrivenFrames& driven) {
  std::vector<double> gaps;
  const auto frames = keyframes_of(driven);
  for (std::size_t k = 1; k < frames.size(); ++k)
    gaps.push_back(driven.s_m[frames[k]] - driven.s_m[frames[k - 1]]);
  return gaps;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(KeyframeSpacing, TakesTheFrameShortOfTheSpacingWhereItIsNearer) {
  for (const double gap : gaps_of(steady(2.4 / 12.5, 0.08, 60))) EXPECT_NEAR(gap, 0.192, 1e-6);
  // Frames whose distance equals or exceeds the spacing are all keyframes.
  EXPECT_EQ(gaps_of(steady(0.31, 0.08, 20)).size(), 19U);
  EXPECT_EQ(gaps_of(steady(0.2, 0.08, 20)).size(), 19U);
  for (const double gap : gaps_of(steady(0.1, 0.08, 40))) EXPECT_NEAR(gap, 0.2, 1e-6);
}

// Frames that are 0.14 m apart cannot give 0.20 m each time, but they can give it on average.
// Without the carried remainder, every frame would be a keyframe.
TEST(KeyframeSpacing, StaysAtTheSpacingOnAverage) {
  for (const double step : {0.09, 0.12, 0.14, 0.15, 0.16}) {
    const auto gaps = gaps_of(steady(step, 0.08, 120));
    EXPECT_NEAR(mean_of(gaps), kSpacing_m, 0.1 * kSpacing_m) << step;
    EXPECT_LE(*std::max_element(gaps.begin(), gaps.end()), std::max(2.0 * step, 0.27) + 1e-6)
        << step;
  }
}

TEST(KeyframeSpacing, HoldsForIrregularFrames) {
  Random random(5);
  DrivenFrames driven;
  double t = 0.0;
  for (int i = 0; i < 250; ++i) {
    driven.t_s.push_back(t);
    driven.s_m.push_back(1.5 * t);
    t += random.uniform(0.02, 0.12);
  }
  const auto gaps = gaps_of(driven);
  EXPECT_NEAR(mean_of(gaps), kSpacing_m, 0.05 * kSpacing_m);
  constexpr double kMost = 1.25 * kSpacing_m + 0.5 * 1.5 * 0.12;
  for (const double gap : gaps) EXPECT_LT(gap, kMost);
}

TEST(KeyframeSpacing, AStandingCarAddsNothing) {
  DrivenFrames driven;
  for (int i = 0; i < 100; ++i) {
    driven.t_s.push_back(0.08 * i);
    const int moving = i < 10 ? i : i < 80 ? 10 : i - 70;  // at rest from 10 to 80
    driven.s_m.push_back(0.13 * moving);
  }
  const auto gaps = gaps_of(driven);
  EXPECT_NEAR(mean_of(gaps), kSpacing_m, 0.1 * kSpacing_m);
  EXPECT_GT(*std::min_element(gaps.begin(), gaps.end()), 0.1);
}

// On a circle of 1 m the turn of 5 degrees comes first, after 0.087 m.
TEST(KeyframeSpacing, ATurnMakesAKeyframeToo) {
  DrivenFrames driven = steady(0.02, 0.08, 120);
  driven.turn_radius_m = 1.0;
  const auto gaps = gaps_of(driven);
  for (const double gap : gaps) EXPECT_NEAR(gap, 0.08, 0.021);
  EXPECT_NEAR(mean_of(gaps), 0.087, 0.012);
}

// The carried remainder is bounded, and a turn adds none to it.
TEST(KeyframeSpacing, CarriesAtMostAQuarterOfTheSpacing) {
  KeyframeSpacing spacing(kSpacing_m, 0.1);
  for (int i = 0; i < 100; ++i) spacing.taken(0.11, 0.0, true);
  EXPECT_NEAR(spacing.progress(0.25, 0.0), 1.0, 1e-12);
  for (int i = 0; i < 100; ++i) spacing.taken(0.9, 0.0, true);
  EXPECT_NEAR(spacing.progress(0.15, 0.0), 1.0, 1e-12);
  spacing.taken(0.9, 0.0, false);
  EXPECT_NEAR(spacing.progress(kSpacing_m, 0.0), 1.0, 1e-12) << "there was no nearer frame";
  spacing.taken(0.05, 0.2, true);
  EXPECT_NEAR(spacing.progress(kSpacing_m, 0.0), 1.0, 1e-12);
}

}  // namespace
}  // namespace roadbook
