#include <gtest/gtest.h>

#include <algorithm>

#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/example_log.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

Diagnosis diagnosed_motion(const PlainLog& log) {
  DiagnosisOptions options;
  options.library.without = log.without;
  return diagnose(log.streams, log.name, options);
}

double size_of(const Diagnosis& d, const std::string& effect) {
  for (const FoundCause& c : d.causes)
    if (c.effect == effect) return c.size;
  ADD_FAILURE() << effect << " was not named";
  return 0.0;
}

// Its makers guess a steering factor of 0.1, a wheelbase of 1.4 m and the tracker at 1.5 m. Dead
// reckoning over windows of one second against the tracker, fitted outside of this program: 0.558,
// 1.516 m, 1.798 m, and 0.010624 m a turn of the traction wheel, which they guessed right.
TEST(MeasuredMotion, FromItsMakersGuessTheTricyclesCalibrationIsFound) {
  ROADBOOK_REQUIRE_DATA(data, "tricycle_calibration");
  const Diagnosis d = diagnosed_motion(test::example_log("tricycle.yaml", data));
  EXPECT_NEAR(0.1 / (1.0 + size_of(d, "steering0.ratio")), 0.558, 0.02);
  EXPECT_NEAR(1.4 * (1.0 + size_of(d, "steering0.wheelbase")), 1.516, 0.04);
  EXPECT_NEAR(1.5 + size_of(d, "cam.position"), 1.798, 0.04);
  for (const FoundCause& c : d.causes) EXPECT_NE(c.effect, "wheels0.radius");
}

// The chassis data of the car state "rear differential: LSD or spool". Both rear wheels turn at the
// same rate in bends.
TEST(MeasuredMotion, TheRaceCarsRearAxleIsLocked) {
  ROADBOOK_REQUIRE_DATA(data, "indy_av21");
  for (const char* part : {"window: {from_s: 100, to_s: 140}", ""}) {  // and as a whole
    const Diagnosis d = diagnosed_motion(test::example_log("indy_av21_road.yaml", data, part));
    EXPECT_NEAR(size_of(d, "wheels0.locked_axle"), 1.0, 0.1) << part;
    for (const FoundCause& c : d.causes) EXPECT_NE(c.effect, "wheels0.track_width") << part;
  }
}

// The reference path is 1.009 times the distance that the wheels rolled (PlainLogOfMeasuredData has
// the same bound), at a mean speed of 18 m/s. In one minute, larger wheels are confounded with
// wheels that grow with speed, and the diagnosis reports this. A camera behind a windscreen looks
// straight ahead within a degree or two.
TEST(MeasuredMotion, TheRoadCarsWheelsAreLargerAndItsReferenceLooksAside) {
  ROADBOOK_REQUIRE_DATA(data, "comma2k19_example");
  const Diagnosis d = diagnosed_motion(test::example_log("comma2k19.yaml", data));
  ASSERT_FALSE(d.causes.empty());
  const FoundCause& wheels = d.causes.front();
  const bool with_speed = wheels.effect == "wheels0.radius_speed";
  EXPECT_NEAR(wheels.size * (with_speed ? 18.0 : 1.0), 0.009, 0.003);
  const std::string other = with_speed ? "wheels0.radius" : "wheels0.radius_speed";
  EXPECT_NE(std::find(wheels.inseparable.begin(), wheels.inseparable.end(), other),
            wheels.inseparable.end());
  EXPECT_LT(std::abs(size_of(d, "cam.rotation")), 0.035);
  for (const FoundCause& c : d.causes) EXPECT_FALSE(c.effect.starts_with("map.")) << c.effect;
}

// The receiver's errors are larger and slower than any effect: only noise is named.
TEST(MeasuredMotion, OfAReceiverThatJumpsNothingPhysicalIsConcluded) {
  ROADBOOK_REQUIRE_DATA(data, "victoria_park");
  const Diagnosis d = diagnosed_motion(
      test::example_log("victoria_park.yaml", data, "window: {from_s: 0, to_s: 250}"));
  for (const FoundCause& c : d.causes) EXPECT_TRUE(c.noise) << c.effect;
  const auto& blind = d.not_observable;
  EXPECT_NE(std::find(blind.begin(), blind.end(), "wheels0.track_width"), blind.end());
}

}  // namespace
}  // namespace roadbook
