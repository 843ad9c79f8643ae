#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnosis/hidden_effects/study_cases.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

// Physically impossible sizes: calibration or recording contradict the readings. Nothing is named
// or unknown; one line of the report explains the contradiction.
void expect_said(const std::string& effect, double size) {
  SCOPED_TRACE(effect);
  HiddenDriveOptions hidden;
  hidden.seed = 5;
  hidden.secret[effect] = size;
  const TemporaryFolder folder;
  const Outcome outcome = diagnose_hidden(hidden, folder.path() / "drive");
  EXPECT_TRUE(outcome.found.causes.empty()) << outcome.to_line();
  EXPECT_TRUE(outcome.found.unknown.empty()) << outcome.to_line();
  EXPECT_TRUE(outcome.found.extended.empty()) << outcome.to_line();
  ASSERT_FALSE(outcome.found.unexplained.empty());
  EXPECT_TRUE(outcome.found.unexplained.front().starts_with("resembles " + effect + " = "))
      << outcome.found.unexplained.front();
}

TEST(Contradictions, AGyroscopeOfTheOtherSign) { expect_said("imu0.gyro_scale", -2.0); }
TEST(Contradictions, AGyroscopeThatDoesNotTurn) { expect_said("imu0.gyro_scale", -1.0); }
TEST(Contradictions, AWheelOfAFractionOfTheRadius) { expect_said("wheels0.radius", 1.1); }
// sensor.yaml states 0.65 m and 0.9 m instead of 0.31 m: linear steps do not converge from there.
TEST(Contradictions, ARadiusOfTwiceTheWheel) { expect_said("wheels0.radius", 0.31 / 0.65 - 1.0); }
TEST(Contradictions, ARadiusOfThreeTimesTheWheel) {
  expect_said("wheels0.radius", 0.31 / 0.9 - 1.0);
}
TEST(Contradictions, OneWheelOfThreeMetres) {
  expect_said("wheels0.right_radius", 0.31 / 3.0 - 1.0);
}
TEST(Contradictions, WheelsThatCountBackwards) { expect_said("wheels0.radius", -2.0); }
// Without this check, the estimated noise would grow until the data no longer contradict the
// calibration.
TEST(Contradictions, AGyroscopeOfTenTimesTheRate) { expect_said("imu0.gyro_scale", 9.0); }
TEST(Contradictions, ATrackOfAThird) { expect_said("wheels0.track_width", 2.0); }
TEST(Contradictions, AWheelbaseOfAQuarter) { expect_said("steering0.wheelbase", 3.0); }
TEST(Contradictions, SteeringOfTheOtherSign) { expect_said("steering0.ratio", -2.0); }

}  // namespace
}  // namespace roadbook::test
