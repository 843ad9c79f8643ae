#include "diagnosis/reckoning_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/planar_car.hpp"

namespace roadbook {
namespace {

constexpr double kTrueRadius = 0.02;
constexpr double kTrueBias = 0.01;  // [rad/s]

// A car at 4 m/s whose wheels are 2 % larger than stated and whose gyro has a bias.
MotionStreams faulty_drive(std::uint64_t seed) {
  MotionStreams streams = test::PlanarCar(seed).record({});
  for (WheelSample& w : streams.wheels) {
    w.left_rad /= 1.0 + kTrueRadius;
    w.right_rad /= 1.0 + kTrueRadius;
  }
  for (GyroSample& g : streams.gyro) g.rate_rad_s += kTrueBias;
  return streams;
}

// 2 % of 20 m along, and across half of the bias times speed times 25 s^2.
TEST(ReckoningError, IsThatOfTheFaultsByHand) {
  const Observations obs = observe(faulty_drive(5));
  const auto before = reckoning_error(obs, {}, {});
  ASSERT_TRUE(before);
  EXPECT_GT(before->pieces, 50U);
  EXPECT_NEAR(before->heading_rad, 5.0 * kTrueBias, 0.003);
  EXPECT_NEAR(before->position_m, std::hypot(0.4, 0.5), 0.1);
  const auto after =
      reckoning_error(obs, {}, {{"wheels0.radius", kTrueRadius}, {"imu0.gyro_bias", kTrueBias}});
  ASSERT_TRUE(after);
  EXPECT_LT(after->heading_rad, 0.01);
  EXPECT_LT(after->position_m, 0.12);
  const auto bias_left = reckoning_error(obs, {}, {{"wheels0.radius", kTrueRadius}});
  ASSERT_TRUE(bias_left);
  EXPECT_NEAR(bias_left->heading_rad, 5.0 * kTrueBias, 0.003);
  EXPECT_NEAR(bias_left->position_m, 0.5, 0.08);
  const auto radius_left = reckoning_error(obs, {}, {{"imu0.gyro_bias", kTrueBias}});
  ASSERT_TRUE(radius_left);
  EXPECT_NEAR(radius_left->position_m, 0.4, 0.08);
}

// The effects of a diagnosis have the error that is left without each of them.
TEST(ReckoningError, OfADiagnosisStandsBesideItsEffects) {
  const Diagnosis d = diagnose(faulty_drive(6), "drive");
  ASSERT_TRUE(d.reckoned_before && d.reckoned_after);
  EXPECT_NEAR(d.reckoned_before->position_m, std::hypot(0.4, 0.5), 0.1);
  EXPECT_LT(d.reckoned_after->position_m, 0.12);
  std::size_t named = 0;
  for (const FoundCause& c : d.causes) {
    if (c.effect != "wheels0.radius" && c.effect != "imu0.gyro_bias") continue;
    ++named;
    ASSERT_TRUE(c.reckoned_without) << c.effect;
    EXPECT_NEAR(c.reckoned_without->position_m, c.effect == "wheels0.radius" ? 0.4 : 0.5, 0.08);
  }
  EXPECT_EQ(named, 2U);
  const Diagnosis sound = diagnose(test::PlanarCar(7).record({}), "drive");
  EXPECT_TRUE(sound.causes.empty());
  EXPECT_FALSE(sound.reckoned_before);
}

TEST(ReckoningError, WithoutWheelsOrInAShortDriveIsUnknown) {
  MotionStreams streams = test::PlanarCar(8).record({});
  MotionStreams shorter = streams;
  std::erase_if(shorter.poses, [](const PoseSample& p) { return p.t_s > 6.0; });
  EXPECT_FALSE(reckoning_error(observe(shorter), {}, {}));
  streams.wheels.clear();
  EXPECT_FALSE(reckoning_error(observe(streams), {}, {}));
}

}  // namespace
}  // namespace roadbook
