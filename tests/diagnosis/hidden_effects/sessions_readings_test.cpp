#include <gtest/gtest.h>

#include <cmath>
#include <list>
#include <utility>

#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "tests/diagnosis/hidden_effects/detector_injector.hpp"
#include "tests/diagnosis/hidden_effects/friction_injector.hpp"
#include "tests/diagnosis/hidden_effects/range_injector.hpp"
#include "tests/drive/drive_fixture.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook::test {
namespace {

// Readings of several drives, from their files only.
class ReadDrives {
 public:
  template <typename Hidden, typename Write>
  void add(const Hidden& hidden, const Write& write) {
    const auto folder = folder_.path() / std::to_string(drives_.size());
    write(hidden, folder);
    const Drive drive = Drive::open(folder);
    add(drive_readings(drive, motion_streams(drive).poses));
  }
  void add(DriveReadings readings) {
    readings_.push_back(std::move(readings));
    drives_.push_back({"day" + std::to_string(drives_.size() + 1), &readings_.back()});
  }
  [[nodiscard]] Diagnosis together() const { return diagnose_readings(drives_); }
  [[nodiscard]] Diagnosis alone(std::size_t d) const {
    return diagnose_readings(*drives_[d].readings);
  }

 private:
  TemporaryFolder folder_;
  std::list<DriveReadings> readings_;
  std::vector<SessionReadings> drives_;
};

// Expects one cause that belongs to the vehicle, with the combined information of all drives.
void expect_common(const ReadDrives& drives, const std::string& effect, double size) {
  const Diagnosis all = drives.together();
  SCOPED_TRACE(told(all));
  ASSERT_EQ(all.causes.size(), 1U);
  const FoundCause& cause = all.causes.front();
  EXPECT_EQ(cause.effect, effect);
  EXPECT_EQ(cause.session, "");
  EXPECT_NEAR(cause.size, size, 4.0 * sigma_of(cause));
  EXPECT_EQ(all.extended.at(effect), cause.size);
  double information = 0.0;
  for (std::size_t d = 0; d < 2; ++d) {
    const Diagnosis one = drives.alone(d);
    ASSERT_EQ(one.causes.size(), 1U) << told(one);
    information += std::pow(sigma_of(one.causes.front()), -2);
  }
  EXPECT_NEAR(sigma_of(cause), 1.0 / std::sqrt(information), 0.15 * sigma_of(cause));
}

TEST(SessionsReadings, ABiasOfTheFrictionSensorIsOneSizeOfAllDrives) {
  ReadDrives drives;
  for (const std::uint64_t seed : {31U, 32U})
    drives.add(FrictionSecret{.seed = seed, .secret = {{"friction0.speed_bias", 0.004}}},
               write_friction_drive);
  expect_common(drives, "friction0.speed_bias", 0.004);
}

TEST(SessionsReadings, ABiasOfOneDriveIsSaidWithTheDrive) {
  ReadDrives drives;
  drives.add(FrictionSecret{.seed = 33, .secret = {}}, write_friction_drive);
  drives.add(FrictionSecret{.seed = 34, .secret = {{"friction0.slip_bias", 0.15}}},
             write_friction_drive);
  const Diagnosis all = drives.together();
  SCOPED_TRACE(told(all));
  ASSERT_EQ(all.causes.size(), 1U);
  EXPECT_EQ(all.causes.front().effect, "friction0.slip_bias");
  EXPECT_EQ(all.causes.front().session, "day2");
  EXPECT_NEAR(all.causes.front().size, 0.15, 4.0 * sigma_of(all.causes.front()));
  EXPECT_TRUE(all.extended.empty());
  for (const std::string& name : all.not_observable) {
    EXPECT_EQ(std::count(all.not_observable.begin(), all.not_observable.end(), name), 1) << name;
    EXPECT_EQ(name.find(" in day"), std::string::npos) << name;
  }
}

// Splits the laps of one scanner: the first lap and the last become separate drives.
std::pair<DriveReadings, DriveReadings> halves(double share) {
  const TemporaryFolder folder;
  write_range_drive(RangeSecret{.seed = 35, .laps = 2, .secret = {{"range0.short", share}}},
                    folder.path() / "drive");
  const Drive drive = Drive::open(folder.path() / "drive");
  DriveReadings first = drive_readings(drive, motion_streams(drive).poses);
  DriveReadings last = first;
  auto& all = first.ranges.samples;
  const double middle = 0.5 * (all.front().t_s + all.back().t_s);
  std::erase_if(all, [&](const ExpectedRange& r) { return r.t_s >= middle; });
  std::erase_if(last.ranges.samples, [&](const ExpectedRange& r) { return r.t_s < middle; });
  return {first, last};
}

TEST(SessionsReadings, SharesOfTheBeamModelThatAgreeAreOfAllDrivesAndOthersOfEach) {
  const auto [first, last] = halves(0.05);
  const auto [unused, more] = halves(0.1);
  ReadDrives alike;
  alike.add(first);
  alike.add(last);
  expect_common(alike, "range0.short", 0.05);
  ReadDrives other;
  other.add(first);
  other.add(more);
  const Diagnosis each = other.together();
  SCOPED_TRACE(told(each));
  ASSERT_EQ(each.causes.size(), 2U);
  for (const FoundCause& c : each.causes)
    EXPECT_NEAR(c.size, c.session == "day1" ? 0.05 : 0.1, 4.0 * sigma_of(c)) << c.session;
  EXPECT_TRUE(each.extended.empty());
}

TEST(SessionsReadings, ADetectorsErrorsAreOfAllDrives) {
  for (const auto& [effect, size] :
       {std::pair{"detector.foot_point", 0.3}, std::pair{"detector.range", 0.35}}) {
    ReadDrives drives;
    for (const std::uint64_t seed : {37U, 38U})
      drives.add(DetectorSecret{.seed = seed, .secret = {{effect, size}}}, write_detector_drive);
    expect_common(drives, effect, size);
  }
}

TEST(SessionsReadings, WhereNothingIsHiddenNothingIsNamed) {
  ReadDrives drives;
  for (const std::uint64_t seed : {39U, 40U})
    drives.add(FrictionSecret{.seed = seed, .secret = {}}, write_friction_drive);
  const Diagnosis all = drives.together();
  EXPECT_TRUE(all.causes.empty() && all.unknown.empty()) << told(all);
}

}  // namespace
}  // namespace roadbook::test
