#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook::test {
namespace {

constexpr const char* kBank = "ground.bank";

MotionStreams drive_with(const Secret& secret, std::uint64_t seed) {
  HiddenDriveOptions options;
  options.seed = seed;
  options.secret = secret;
  return streams_of(record_drive(options));
}

bool names_in_set(const Diagnosis& d, const std::string& effect) {
  if (d.causes.empty()) return false;
  const FoundCause& first = d.causes.front();
  return first.effect == effect || holds(first.inseparable, effect);
}

// 5 to 25 degrees. Wheels, steering and gyro all turn less than the map, which one cause explains.
TEST(BankedBends, AreNamedByTheirBankBesideWheelsAndSteering) {
  for (const double degrees : {5.0, 10.0, 25.0}) {
    const double size = 1.0 - std::cos(degrees * std::acos(-1.0) / 180.0);
    const Diagnosis d = diagnose(drive_with({{kBank, size}}, 22), "drive");
    SCOPED_TRACE(std::to_string(degrees) + " degrees: " + told(d));
    ASSERT_EQ(d.causes.size(), 1U);
    EXPECT_EQ(d.causes[0].effect, kBank);
    EXPECT_NEAR(d.causes[0].size, size, 4.0 * sigma_of(d.causes[0]));
    EXPECT_TRUE(d.causes[0].inseparable.empty());
  }
}

// Alone, a gyro in banked bends reads as one with a wrong scale: both are in the named set.
TEST(BankedBends, AreInTheNamedSetWhereTheGyroIsAlone) {
  MotionStreams streams = drive_with({{kBank, 0.03}}, 23);
  streams.wheels.clear();
  streams.steering.clear();
  streams.imu.clear();
  const Diagnosis d = diagnose(streams, "drive");
  SCOPED_TRACE(told(d));
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_TRUE(names_in_set(d, kBank));
  EXPECT_TRUE(names_in_set(d, "imu0.gyro_scale"));
}

// The reference's roll levels the streams; what is then too small is the gyro's.
TEST(BankedBends, AreNoCauseWhereTheReferenceKnowsTheBank) {
  MotionStreams streams = drive_with({{"imu0.gyro_scale", -0.03}}, 24);
  streams.wheels.clear();
  streams.steering.clear();
  streams.imu.clear();
  streams.bank_is_known = true;
  const Diagnosis d = diagnose(streams, "drive");
  ASSERT_EQ(d.causes.size(), 1U) << told(d);
  EXPECT_EQ(d.causes[0].effect, "imu0.gyro_scale");
  EXPECT_TRUE(d.causes[0].inseparable.empty());
  EXPECT_FALSE(holds(d.looked_for, kBank));
}

}  // namespace
}  // namespace roadbook::test
