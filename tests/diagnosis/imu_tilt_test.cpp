#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/gravity.hpp"
#include "base/random.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/sessions_diagnosis.hpp"
#include "diagnosis/tilt/tilt_diagnosis.hpp"
#include "diagnosis/tilt/tilt_problem.hpp"
#include "sensors/imu_imperfections.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"
#include "tests/support/diagnosis_outcome.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook::test {
namespace {

constexpr const char* kRoll = "imu0.tilt_roll";
constexpr const char* kPitch = "imu0.tilt_pitch";

MotionStreams tilted(const Secret& secret, std::uint64_t seed, bool straight = false) {
  HiddenDriveOptions options;
  options.seed = seed;
  options.straight = straight;
  options.secret = secret;
  return streams_of(record_drive(options));
}

// By hand: rolled to its right by 90 degrees, the left axis points up and the up axis to the right.
// Lifted by 90 degrees, the front axis points up and the up axis back.
TEST(ImuTilt, TurnsTheAxesAsDeclared) {
  const double quarter = std::acos(0.0);
  const Eigen::Matrix3d rolled = tilt_rotation(quarter, 0.0);
  EXPECT_LT((rolled.col(1) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((rolled.col(2) + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  const Eigen::Matrix3d lifted = tilt_rotation(0.0, quarter);
  EXPECT_LT((lifted.col(0) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((lifted.col(2) + Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

TEST(ImuTilt, TakenOffTheReadingsAreThoseOfTheStatedAxes) {
  const Eigen::Vector3d rate(0.1, -0.2, 0.7), force(1.0, 2.0, 9.0);
  const Eigen::Matrix3d tilt = tilt_rotation(0.1, -0.3);
  MotionStreams streams;
  streams.imu.push_back({0.0, tilt.transpose() * rate, tilt.transpose() * force});
  streams.gyro.push_back({0.0, streams.imu[0].rate_rad_s.z()});
  remove_tilt(0.1, -0.3, streams);
  EXPECT_LT((streams.imu[0].rate_rad_s - rate).norm(), 1e-12);
  EXPECT_LT((streams.imu[0].force_m_s2 - force).norm(), 1e-12);
  EXPECT_NEAR(streams.gyro[0].rate_rad_s, 0.7, 1e-12);
}

// A tilt of 0.1 rad takes 0.5 % of each turn, which the scale of the gyro would explain as well:
// the cause is named and the scale is not.
TEST(ImuTilt, IsNamedWithItsSizesAndNoScaleOfTheGyro) {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Random random(seed, "tilt");
    const double roll = random.uniform(0.05, 0.12), pitch = random.uniform(-0.12, -0.05);
    const Diagnosis d = diagnose(tilted({{kRoll, roll}, {kPitch, pitch}}, seed), "drive");
    SCOPED_TRACE(told(d));
    ASSERT_EQ(d.causes.size(), 2U);
    EXPECT_TRUE(d.unknown.empty());
    for (const auto& [name, size] : {std::pair{kRoll, roll}, std::pair{kPitch, pitch}}) {
      const FoundCause* cause = cause_named(d, name);
      ASSERT_NE(cause, nullptr) << name;
      EXPECT_NEAR(cause->size, size, 4.0 * sigma_of(*cause));
      EXPECT_LT(sigma_of(*cause), 5e-4);
      EXPECT_TRUE(cause->inseparable.empty());
      held += size >= cause->low && size <= cause->high ? 1 : 0;
      EXPECT_EQ(d.extended.at(name), cause->size);
    }
  }
  EXPECT_GE(held, 5);  // of six intervals of 95 %: two misses happen in 3 % of all seeds
}

TEST(ImuTilt, OfALevelImuNothingIsNamedAndTheTiltCountsAsLookedFor) {
  const Diagnosis d = diagnose(tilted({}, 4), "drive");
  EXPECT_TRUE(d.causes.empty() && d.unknown.empty()) << told(d);
  EXPECT_TRUE(shows(d, kRoll));
  EXPECT_TRUE(shows(d, kPitch));
}

// The other errors of a gyro do not change the tilt: it compares axes of one sensor.
TEST(ImuTilt, IsTheSameBesideOtherErrorsOfTheGyro) {
  const Secret others{{"imu0.latency", 0.05}, {"imu0.gyro_bias", 0.01}};
  Secret both = others;
  both[kRoll] = 0.06;
  const Diagnosis d = diagnose(tilted(both, 5), "drive");
  SCOPED_TRACE(told(d));
  ASSERT_EQ(d.causes.size(), 3U);
  const FoundCause* roll = cause_named(d, kRoll);
  ASSERT_NE(roll, nullptr);
  EXPECT_NEAR(roll->size, 0.06, 4.0 * sigma_of(*roll));
  EXPECT_NE(cause_named(d, "imu0.latency"), nullptr);
  EXPECT_NE(cause_named(d, "imu0.gyro_bias"), nullptr);
}

TEST(ImuTilt, WithTheKnownSizeNothingIsLeftAndOfAWrongOneTheDifferenceIs) {
  const MotionStreams streams = tilted({{kRoll, 0.08}}, 6);
  DiagnosisOptions options;
  options.known = {{kRoll, 0.08}};
  const Diagnosis right = diagnose(streams, "drive", options);
  EXPECT_TRUE(right.causes.empty()) << told(right);
  EXPECT_EQ(right.extended.at(kRoll), 0.08);
  options.known = {{kRoll, 0.05}};
  const Diagnosis wrong = diagnose(streams, "drive", options);
  ASSERT_EQ(wrong.causes.size(), 1U) << told(wrong);
  EXPECT_NEAR(wrong.causes[0].size, 0.03, 1e-3);
  EXPECT_NEAR(wrong.extended.at(kRoll), 0.08, 1e-3);
}

// Without turns gravity alone shows the tilt, and the bias of an accelerometer looks the same.
TEST(ImuTilt, OnAStraightDriveIsNotObservableAndALargeOneIsNoted) {
  const auto notes_of = [](double pitch) {
    const Diagnosis d = diagnose(tilted({{kPitch, pitch}}, 7, true), "drive");
    EXPECT_EQ(cause_named(d, kPitch), nullptr) << told(d);
    EXPECT_FALSE(shows(d, kPitch));
    std::string notes;
    for (const std::string& note : d.notes) notes += note + "\n";
    return notes;
  };
  EXPECT_EQ(notes_of(0.02).find("gravity"), std::string::npos);
  EXPECT_NE(notes_of(0.3).find("gravity resembles imu0.tilt_pitch = 0.30 rad"), std::string::npos)
      << notes_of(0.3);
  EXPECT_EQ(notes_of(0.3).find("tilt_roll"), std::string::npos);
}

// The note is not for a tilt that the user left out.
TEST(ImuTilt, ThatIsLeftOutIsNotNotedByGravity) {
  DiagnosisOptions options;
  options.library.without = {kPitch};
  const Diagnosis d = diagnose(tilted({{kPitch, 0.3}}, 7), "drive", options);
  for (const std::string& note : d.notes)
    EXPECT_EQ(note.find("gravity"), std::string::npos) << note;
}

TEST(ImuTilt, IsNotLookedForWhereOneAxisAloneIsMeasured) {
  MotionStreams streams = tilted({{kRoll, 0.1}}, 8);
  for (ImuSample& s : streams.imu) {
    s.rate_rad_s.x() = s.rate_rad_s.y() = 0.0;
    s.force_m_s2 = Eigen::Vector3d::Zero();
  }
  const Diagnosis d = diagnose(streams, "drive");
  EXPECT_FALSE(holds(d.looked_for, kRoll));
  EXPECT_EQ(cause_named(d, kRoll), nullptr);
}

// A road that is banked everywhere turns the whole car, which its reference says: on a circle the
// gyro's y axis reads sin(bank) of the turn, as of a rolled mount.
TEST(ImuTilt, IsAgainstTheAttitudeOfTheReference) {
  constexpr double kRoadBank = 0.15, kTilt = 0.04;
  Random random(9, "circle");
  std::vector<TiltWindow> windows;
  for (int k = 0; k < 600; ++k) {
    TiltWindow w;
    w.t_s = 0.08 * k;
    const double turn = 0.3 * std::sin(0.05 * w.t_s * w.t_s);
    w.speed = 5.0;
    w.up = {0.0, std::sin(kRoadBank), std::cos(kRoadBank)};
    const Eigen::Matrix3d axes = tilt_rotation(kTilt, 0.0).transpose();
    const auto noise = [&](double sigma) {
      return Eigen::Vector3d(sigma * random.normal(), sigma * random.normal(),
                             sigma * random.normal());
    };
    w.rate = axes * (turn * w.up) + noise(1e-3);
    w.force = axes * (Eigen::Vector3d(0.0, w.speed * turn * w.up.z(), 0.0) + kGravity * w.up) +
              noise(0.02);
    windows.push_back(w);
  }
  const auto roll_of = [](const std::vector<TiltWindow>& all) {
    const Diagnosis d = roadbook::diagnose(TiltProblem(all, {true, true}, true), {});
    const FoundCause* cause = cause_named(d, kRoll);
    return cause == nullptr ? 0.0 : cause->size;
  };
  EXPECT_NEAR(roll_of(windows), kTilt, 2e-3);
  for (TiltWindow& w : windows) w.up = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(roll_of(windows), kRoadBank + kTilt, 0.01);
}

TEST(ImuTilt, OfSeveralDrivesIsOneSizeOfTheVehicle) {
  std::vector<SessionStreams> drives;
  for (const std::uint64_t seed : {10, 11})
    drives.push_back({"day" + std::to_string(seed), tilted({{kPitch, 0.07}}, seed)});
  const Diagnosis d = diagnose_sessions(drives);
  SCOPED_TRACE(told(d));
  ASSERT_EQ(d.causes.size(), 1U);
  EXPECT_EQ(d.causes[0].effect, kPitch);
  EXPECT_EQ(d.causes[0].session, "");
  EXPECT_NEAR(d.causes[0].size, 0.07, 4.0 * sigma_of(d.causes[0]));
  EXPECT_EQ(d.extended.at(kPitch), d.causes[0].size);
}

}  // namespace
}  // namespace roadbook::test
