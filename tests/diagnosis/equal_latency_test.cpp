#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/motion/effect_columns.hpp"
#include "diagnosis/streams/motion_effects.hpp"
#include "tests/diagnosis/planar_car.hpp"

namespace roadbook::test {
namespace {

constexpr std::uint64_t kCars = 4;

bool says(const FoundCause& cause, const std::string& name) {
  return cause.effect == name || std::find(cause.inseparable.begin(), cause.inseparable.end(),
                                           name) != cause.inseparable.end();
}

// Either sign, up to 60 ms.
double draw_delay(PlanarCar& car, double least) {
  const double size = car.uniform(least, 0.06);
  return car.uniform(-1.0, 1.0) < 0.0 ? -size : size;
}

// A 95 % interval times 1.5 has a coverage of 99.7 %.
void expect_size(const FoundCause& cause, double size) {
  EXPECT_NEAR(cause.size, size, 0.75 * (cause.high - cause.low)) << cause.effect;
}

// Without heading noise the poses of the knots follow wheels and gyro, and a difference of poses
// over a knot has the largest error.
std::vector<PlanarCarOptions> cars() {
  PlanarCarOptions usual;
  PlanarCarOptions sure_headings;
  sure_headings.position_m = 0.05;
  sure_headings.heading_rad = 1e-4;
  return {usual, sure_headings};
}

TEST(EqualLatencies, OfWheelsAndGyroAreThePosesOwn) {
  for (std::uint64_t seed = 0; seed < kCars; ++seed)
    for (PlanarCarOptions options : cars()) {
      SCOPED_TRACE(seed);
      PlanarCar car(20261123 + seed);
      options.poses_late_s = draw_delay(car, 0.01);
      const Diagnosis d = diagnose(car.record(options), "late poses");
      ASSERT_EQ(d.causes.size(), 1U) << options.poses_late_s;
      EXPECT_TRUE(d.unknown.empty());
      EXPECT_EQ(d.causes[0].effect, "cam.latency");
      expect_size(d.causes[0], options.poses_late_s);
    }
}

TEST(EqualLatencies, OfWheelsThatAreAloneMayBeThePosesAsWell) {
  for (std::uint64_t seed = 0; seed < kCars; ++seed) {
    SCOPED_TRACE(seed);
    PlanarCar car(20261123 + seed);
    PlanarCarOptions options;
    options.with_gyro = false;
    const double late = draw_delay(car, 0.025);
    (seed % 2 == 0 ? options.poses_late_s : options.wheels_late_s) = late;
    const Diagnosis d = diagnose(car.record(options), "wheels and poses");
    ASSERT_EQ(d.causes.size(), 1U);
    EXPECT_TRUE(says(d.causes[0], "cam.latency"));
    EXPECT_TRUE(says(d.causes[0], "wheels0.latency"));
    const bool of_poses = d.causes[0].effect == "cam.latency";
    expect_size(d.causes[0], of_poses == (seed % 2 == 0) ? late : -late);
  }
}

double size_of_effect(const Diagnosis& d, const std::string& name) {
  const auto size = d.extended.find(name);
  return size == d.extended.end() ? 0.0 : size->second;
}

// Three clocks have two observable differences, whichever two effects describe them.
TEST(EqualLatencies, ThatDifferAreTwoNames) {
  for (std::uint64_t seed = 0; seed < kCars; ++seed) {
    SCOPED_TRACE(seed);
    PlanarCar car(20261123 + seed);
    PlanarCarOptions options;
    options.wheels_late_s = car.uniform(0.03, 0.06);
    options.gyro_late_s = -car.uniform(0.01, 0.03);
    const Diagnosis d = diagnose(car.record(options), "two clocks");
    ASSERT_EQ(d.causes.size(), 2U);
    EXPECT_TRUE(d.unknown.empty());
    for (const FoundCause& c : d.causes) EXPECT_TRUE(c.effect.ends_with(".latency")) << c.effect;
    const double poses = size_of_effect(d, "cam.latency");
    constexpr double kWheelsTell = 0.006;  // [s], three standard errors
    constexpr double kGyroTells = 0.001;
    EXPECT_NEAR(size_of_effect(d, "wheels0.latency") - poses, options.wheels_late_s, kWheelsTell);
    EXPECT_NEAR(size_of_effect(d, "imu0.latency") - poses, options.gyro_late_s, kGyroTells);
  }
}

TEST(EqualLatencies, AreNotNamedWhereNothingIsLate) {
  for (std::uint64_t seed = 0; seed < kCars; ++seed)
    for (const PlanarCarOptions& options : cars()) {
      SCOPED_TRACE(seed);
      PlanarCar car(20261123 + seed);
      const Diagnosis d = diagnose(car.record(options), "in time");
      for (const FoundCause& c : d.causes) ADD_FAILURE() << c.effect << " " << c.size;
      for (const UnknownCause& u : d.unknown) ADD_FAILURE() << u.hook << " ~ " << u.depends_on;
    }
}

// Knots that do not follow from the rates between them, as after smoothing.
TEST(EqualLatencies, APoseThatIsLateShowsTheRatesOfItsMomentAtAKnot) {
  Observations obs;
  obs.step_s = 0.08;
  MotionPoint point;
  point.trajectory = Trajectory(0.0, obs.step_s, 20);
  Trajectory& t = point.trajectory;
  for (std::size_t j = 0; j < t.knots(); ++j) {
    t.speed[j] = 4.0;
    t.yaw_rate[j] = 0.2;
    t.x[j] = 4.0 * t.knot_s(j) + (j % 2 == 0 ? 0.01 : -0.01);
    t.heading[j] = j % 2 == 0 ? 0.005 : -0.005;
    obs.poses.push_back({t.knot_s(j), 0.0, 0.0, 0.0});
  }
  t.integrate();
  const Columns columns = effect_column(obs, point, effect_index("cam.latency"));
  const auto rows = [&](Channel c) { return columns.of(c).front().values; };
  for (std::size_t j = 1; j + 1 < t.knots(); ++j) {
    EXPECT_NEAR(rows(Channel::kPoseAlong)[j], -4.0, 1e-6);
    EXPECT_NEAR(rows(Channel::kPoseAcross)[j], 0.0, 1e-6);
    EXPECT_NEAR(rows(Channel::kPoseHeading)[j], -0.2, 1e-6);
  }
}

}  // namespace
}  // namespace roadbook::test
