#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "diagnosis/sessions_diagnosis.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"
#include "tests/diagnosis/hidden_effects/seed_of_today.hpp"
#include "tests/drive/drive_fixture.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook::test {
namespace {

// Reads drives of one vehicle from the disk, without access to the secret.
std::vector<SessionStreams> drives_with(const std::vector<Secret>& secrets,
                                        std::uint64_t seed,
                                        double length_m = 150.0) {
  std::vector<SessionStreams> drives;
  const TemporaryFolder folder;
  for (std::size_t d = 0; d < secrets.size(); ++d) {
    HiddenDriveOptions hidden;
    hidden.seed = Random(seed, "session", d)() >> 1U;
    hidden.length_m = length_m;
    hidden.secret = secrets[d];
    const std::string name = "day" + std::to_string(d + 1);
    write_recording(record_drive(hidden), folder.path() / name);
    drives.push_back({name, motion_streams(Drive::open(folder.path() / name))});
  }
  return drives;
}

// Size and sign from the date.
double size_of_today(double low, double high, std::uint64_t index) {
  Random random(seed_of_today(), "size", index);
  const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
  return sign * low * std::pow(high / low, random.uniform());
}

TEST(Sessions, ACauseOfTheVehicleIsOneSizeAndSurerThanOfAnyDriveAlone) {
  const double size = size_of_today(0.01, 0.03, 0);
  const Secret secret{{"imu0.gyro_scale", size}};
  const auto drives = drives_with({secret, secret, secret}, seed_of_today());
  const Diagnosis all = diagnose_sessions(drives);
  SCOPED_TRACE(told(all));
  ASSERT_EQ(all.causes.size(), 1U);
  EXPECT_TRUE(all.unknown.empty());
  const FoundCause& cause = all.causes.front();
  EXPECT_EQ(cause.effect, "imu0.gyro_scale");
  EXPECT_EQ(cause.session, "");
  EXPECT_NEAR(cause.size, size, 4.0 * sigma_of(cause));
  // Information adds.
  double information = 0.0;
  for (const SessionStreams& drive : drives) {
    const Diagnosis one = diagnose(drive.streams, drive.name);
    ASSERT_FALSE(one.causes.empty()) << drive.name;
    ASSERT_EQ(one.causes.front().effect, "imu0.gyro_scale") << drive.name;
    information += std::pow(sigma_of(one.causes.front()), -2);
  }
  EXPECT_NEAR(sigma_of(cause), 1.0 / std::sqrt(information), 0.15 * sigma_of(cause));
  EXPECT_EQ(all.extended.at("imu0.gyro_scale"), cause.size);
}

TEST(Sessions, ACauseOfOneDriveIsNamedWithThatDriveAndNotPutIntoTheVehiclesModel) {
  const double size = size_of_today(0.02, 0.05, 1);
  const auto drives = drives_with({{}, {{"wheels0.latency", size}}}, seed_of_today() + 1000);
  const Diagnosis all = diagnose_sessions(drives);
  SCOPED_TRACE(told(all));
  ASSERT_EQ(all.causes.size(), 1U);
  EXPECT_EQ(all.causes.front().effect, "wheels0.latency");
  EXPECT_EQ(all.causes.front().session, "day2");
  EXPECT_NEAR(all.causes.front().size, size, 4.0 * sigma_of(all.causes.front()));
  EXPECT_TRUE(all.extended.empty());
}

TEST(Sessions, OneOfTheVehicleAndOneOfADriveAreBothNamed) {
  const double size = size_of_today(0.005, 0.02, 2);
  const auto drives =
      drives_with({{{"wheels0.radius_difference", size}},
                   {{"wheels0.radius_difference", size}, {"imu0.gyro_bias", 0.004}}},
                  seed_of_today() + 2000);
  const Diagnosis all = diagnose_sessions(drives);
  SCOPED_TRACE(told(all));
  ASSERT_EQ(all.causes.size(), 2U);
  for (const FoundCause& c : all.causes) {
    const bool bias = c.effect == "imu0.gyro_bias";
    EXPECT_EQ(c.session, bias ? "day2" : "");
    EXPECT_NEAR(c.size, bias ? 0.004 : size, 4.0 * sigma_of(c));
  }
}

// Terms of the grammar that all drives share must not replace a cause that only one drive has.
TEST(Sessions, ALargeCauseOfOneAmongFourIsNamedThereAndRaisesNoUnknown) {
  for (std::uint64_t k = 0; k < 2; ++k) {
    Random random(seed_of_today(), "one of four", k);
    const std::size_t whose = random.below(4);
    const double size = (random.uniform() < 0.5 ? -1.0 : 1.0) * random.uniform(0.01, 0.08);
    std::vector<Secret> secrets(4);
    secrets[whose] = {{"imu0.gyro_bias", size}};
    const Diagnosis all = diagnose_sessions(drives_with(secrets, seed_of_today() + 5000 + k));
    SCOPED_TRACE(std::to_string(size) + " in day" + std::to_string(whose + 1) + ": " + told(all));
    EXPECT_TRUE(all.unknown.empty());
    ASSERT_EQ(all.causes.size(), 1U);
    EXPECT_EQ(all.causes.front().effect, "imu0.gyro_bias");
    EXPECT_EQ(all.causes.front().session, "day" + std::to_string(whose + 1));
    EXPECT_NEAR(all.causes.front().size, size, 4.0 * sigma_of(all.causes.front()));
  }
}

// An impossible size of one drive must not be subtracted from the others.
TEST(Sessions, AnImpossibleCauseOfOneAmongFourIsSaidThereAndRaisesNothingElse) {
  std::vector<Secret> secrets(4);
  secrets[1] = {{"imu0.gyro_bias", 1.0}};
  const Diagnosis all = diagnose_sessions(drives_with(secrets, 17));
  SCOPED_TRACE(told(all));
  EXPECT_TRUE(all.causes.empty());
  EXPECT_TRUE(all.unknown.empty());
  ASSERT_EQ(all.unexplained.size(), 1U);
  EXPECT_TRUE(all.unexplained[0].starts_with("resembles imu0.gyro_bias in day2 = 1 rad/s"))
      << all.unexplained[0];
}

// One drive of ten is as long as a tenth of all: it must not be held out whole.
TEST(Sessions, ACauseOfTheFirstOfTenDrivesIsNamed) {
  std::vector<Secret> secrets(10);
  secrets.front() = {{"imu0.gyro_bias", 0.01}};
  const Diagnosis all = diagnose_sessions(drives_with(secrets, seed_of_today() + 4000, 60.0));
  SCOPED_TRACE(told(all));
  ASSERT_EQ(all.causes.size(), 1U);
  EXPECT_EQ(all.causes.front().effect, "imu0.gyro_bias");
  EXPECT_EQ(all.causes.front().session, "day1");
  EXPECT_NEAR(all.causes.front().size, 0.01, 4.0 * sigma_of(all.causes.front()));
}

// The threshold is lower if only names compete. Several drives use the same lower threshold as a
// single drive.
TEST(Sessions, NamesAreJudgedAgainstNamesAsOfOneDrive) {
  const auto drives = drives_with({{}, {}}, seed_of_today() + 6000, 60.0);
  std::vector<PreparedMotion> prepared;
  for (const SessionStreams& drive : drives)
    prepared.push_back(prepare_motion(drive.streams, drive.name));
  const SessionsProblem both(
      {{"day1", prepared[0].problem.get()}, {"day2", prepared[1].problem.get()}});
  EXPECT_GT(both.level_of_names(), 0.0);
  EXPECT_EQ(both.level_of_names(),
            std::min(prepared[0].problem->level_of_names(), prepared[1].problem->level_of_names()));
}

// Of several drives, the report names the manoeuvre that separates two effects, as it does of one
// drive. Only a further drive can show whether a cause belongs to one drive or to the vehicle.
TEST(Sessions, TheDriveThatWouldTellNamesApartIsSaid) {
  const auto drives = drives_with({{{"wheels0.latency", 0.05}}, {{"wheels0.latency", 0.05}}},
                                  seed_of_today() + 7000);
  std::vector<PreparedMotion> prepared;
  for (const SessionStreams& drive : drives)
    prepared.push_back(prepare_motion(drive.streams, drive.name));
  const SessionsProblem both(
      {{"day1", prepared[0].problem.get()}, {"day2", prepared[1].problem.get()}});
  CauseModel model = both.nominal();
  Candidate latency, slip, own;
  for (const Candidate& c : both.project(model, both.candidates(model)).candidates) {
    if (c.name == "wheels0.latency") latency = c;
    if (c.name == "wheels0.slip_acceleration") slip = c;
    if (c.name == "wheels0.latency in day2") own = c;
  }
  accept(model, latency);
  both.fit(model, 3);
  const std::string apart = both.separating(model, 0, {slip}, 5.0);
  EXPECT_NE(apart.find("would separate them"), std::string::npos) << apart;
  EXPECT_EQ(both.separating(model, 0, {own}, 5.0),
            "a further drive would show whether the vehicle has the effect, or this drive alone");
  EXPECT_EQ(
      both.separating(model, 0, {slip, own}, 5.0),
      apart +
          "; a further drive would show whether the vehicle has the effect, or this drive alone");
}

TEST(Sessions, WhereNothingIsHiddenNothingIsNamed) {
  const Diagnosis all = diagnose_sessions(drives_with({{}, {}, {}}, seed_of_today() + 3000));
  EXPECT_TRUE(all.causes.empty() && all.unknown.empty()) << told(all);
  for (const std::string& name : all.not_observable)
    EXPECT_EQ(name.find(" in day"), std::string::npos);
}

}  // namespace
}  // namespace roadbook::test
