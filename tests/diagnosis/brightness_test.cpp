#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/random.hpp"
#include "diagnosis/brightness/brightness_problem.hpp"
#include "diagnosis/inference/findings.hpp"

namespace roadbook {
namespace {

// Landmarks with random brightness, each seen by two or three cameras at several radii. Independent
// camera model: exposure times transmission, to the power of 1 / 2.2.
std::vector<BrightnessSample> samples_of(std::uint64_t seed,
                                         const std::array<double, 4>& exposure,
                                         const std::array<double, 4>& vignetting) {
  Random random(seed, "brightness");
  std::vector<BrightnessSample> samples;
  for (int landmark = 0; landmark < 500; ++landmark) {
    const double light = random.uniform(0.1, 0.8);
    const int first = static_cast<int>(random.below(4));
    for (int i = 0; i < 5; ++i) {
      BrightnessSample s;
      s.landmark = landmark;
      s.camera = (first + i / 2) % 4;
      s.t_s = 0.1 * landmark + 0.3 * i;
      s.radius = random.uniform(0.05, 0.95);
      const auto c = static_cast<std::size_t>(s.camera);
      const double seen = light * (1.0 + exposure[c]) * (1.0 - vignetting[c] * s.radius * s.radius);
      s.log_grey = std::log(255.0 * std::pow(seen, 1.0 / 2.2)) + 0.05 * random.normal();
      if (random.uniform() < 0.03) s.log_grey += random.uniform(-1.0, 1.0);
      s.log_distance = random.uniform(0.0, 2.0);
      samples.push_back(s);
    }
  }
  return samples;
}

Diagnosis diagnosed_brightness(const std::vector<BrightnessSample>& samples) {
  return diagnose(BrightnessProblem(samples, {"cam0", "cam1", "cam2", "cam3"}));
}

TEST(Brightness, VignettingOfOneCameraIsNamedWithItsSize) {
  const Diagnosis d = diagnosed_brightness(samples_of(1, {}, {0.0, 0.5, 0.0, 0.0}));
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_EQ(d.causes[0].effect, "cam1.vignetting");
  EXPECT_LT(d.causes[0].low, 0.5);
  EXPECT_GT(d.causes[0].high, 0.5);
}

TEST(Brightness, VignettingOfAllCamerasIsThatOfTheRig) {
  const Diagnosis d = diagnosed_brightness(samples_of(2, {}, {0.4, 0.4, 0.4, 0.4}));
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_EQ(d.causes[0].effect, "cam.vignetting");
  EXPECT_NEAR(d.causes[0].size, 0.4, 0.06);
}

TEST(Brightness, ExposureOfOneCameraIsNamedAgainstTheOthers) {
  const Diagnosis d = diagnosed_brightness(samples_of(3, {0.0, 0.0, 0.0, -0.3}, {}));
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_EQ(d.causes[0].effect, "cam3.exposure");
  EXPECT_NEAR(d.causes[0].size, -0.3, 0.08);
}

TEST(Brightness, ExposureOfAllCamerasAlikeCannotBeSeen) {
  const Diagnosis d = diagnosed_brightness(samples_of(4, {0.5, 0.5, 0.5, 0.5}, {}));
  EXPECT_TRUE(d.causes.empty());
  EXPECT_EQ(std::count(d.not_observable.begin(), d.not_observable.end(), "cam.exposure"), 1);
}

std::vector<BrightnessSample> with_step(std::uint64_t seed, int camera, double share) {
  std::vector<BrightnessSample> samples = samples_of(seed, {}, {});
  for (BrightnessSample& s : samples) {
    s.t_s = 0.9 * std::floor(s.t_s / 0.9);  // a few images
    if (s.t_s > 20.0 && (camera < 0 || s.camera == camera))
      s.log_grey += std::log(1.0 + share) / 2.2;
  }
  return samples;
}

TEST(Brightness, AStepOfTheExposureIsNamedWithItsTime) {
  for (const int camera : {-1, 2}) {
    const Diagnosis d = diagnosed_brightness(with_step(5, camera, -0.4));
    ASSERT_EQ(d.causes.size(), 1U);
    EXPECT_EQ(d.causes[0].effect, camera < 0 ? "cam.exposure_step" : "cam2.exposure_step");
    EXPECT_LT(d.causes[0].low, -0.4);
    EXPECT_GT(d.causes[0].high, -0.4);
    double from_s = 0.0;
    ASSERT_EQ(std::sscanf(d.causes[0].note.c_str(), "from %lf s", &from_s), 1);
    EXPECT_NEAR(from_s, 20.25, 1.0);  // the instants about it are 19.8 and 20.7
  }
}

TEST(Brightness, AStepThatIsKnownLeavesNothing) {
  const Diagnosis d = diagnose(BrightnessProblem(
      with_step(6, 1, 0.5), {"cam0", "cam1", "cam2", "cam3"}, {{"cam1.exposure_step", 0.5}}));
  EXPECT_TRUE(d.causes.empty());
}

// The steps of the rig and of one camera add up, as in `simulate`.
TEST(Brightness, AStepOfTheRigAndOneOfACameraThatAreKnownLeaveNothing) {
  std::vector<BrightnessSample> samples = samples_of(7, {}, {});
  for (BrightnessSample& s : samples) {
    s.t_s = 0.9 * std::floor(s.t_s / 0.9);
    if (s.t_s > 20.0) s.log_grey += std::log(1.0 - 0.4 + (s.camera == 2 ? 0.3 : 0.0)) / 2.2;
  }
  const Diagnosis d =
      diagnose(BrightnessProblem(samples, {"cam0", "cam1", "cam2", "cam3"},
                                 {{"cam.exposure_step", -0.4}, {"cam2.exposure_step", 0.3}}));
  for (const FoundCause& c : d.causes) ADD_FAILURE() << c.effect << " " << c.size;
}

TEST(Brightness, NothingIsNamedWhereNothingIsWrong) {
  for (std::uint64_t seed = 10; seed < 40; ++seed) {
    const Diagnosis d = diagnosed_brightness(samples_of(seed, {}, {}));
    EXPECT_TRUE(d.causes.empty() && d.unknown.empty()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace roadbook
