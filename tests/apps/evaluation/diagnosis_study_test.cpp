#include "apps/evaluation/diagnosis_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "apps/evaluation/hidden_drive.hpp"
#include "base/random.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/motion/motion_model.hpp"
#include "diagnosis/oracle.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "diagnosis/streams/observe.hpp"
#include "drive/drive.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook {
namespace {

DiagnosisStudyOptions short_study(const std::filesystem::path& folder) {
  DiagnosisStudyOptions options;
  options.folder = folder;
  options.seed = 12;
  options.drives_an_effect = 1;
  options.null_drives = 3;
  options.readings = false;
  options.length_m = 100.0;
  return options;
}

// The simulation's own car hides the effects. The diagnosis names strong effects and nothing else.
// For the effects of the gyro and of the poses, two threads give bit-identical results.
TEST(DiagnosisStudy, StrongEffectsAreNamedAndThreadsDoNotMatter) {
  const test::TemporaryFolder folder;
  const auto one = run_diagnosis_study(short_study(folder.path() / "one"));
  DiagnosisScore score;
  for (const StudiedDrive& drive : one) {
    SCOPED_TRACE(drive.effect);
    if (drive.effect.empty()) {
      EXPECT_EQ(drive.answer(), "nothing");
    } else {
      score.add(drive);
    }
  }
  EXPECT_GE(score.strong, 8U);
  EXPECT_GE(score.strong_in_set + 1, score.strong);
  EXPECT_LE(score.wrong, 1U);

  DiagnosisStudyOptions some = short_study(folder.path() / "two");
  some.only = "imu0,poses";
  some.num_threads = 2;
  std::size_t compared = 0;
  std::size_t causes = 0;
  for (const StudiedDrive& two : run_diagnosis_study(some)) {
    if (two.effect.empty()) continue;
    SCOPED_TRACE(two.effect);
    const auto same = std::find_if(one.begin(), one.end(),
                                   [&](const StudiedDrive& d) { return d.effect == two.effect; });
    ASSERT_NE(same, one.end());
    ++compared;
    EXPECT_EQ(same->answer(), two.answer());
    ASSERT_EQ(same->found.causes.size(), two.found.causes.size());
    for (std::size_t k = 0; k < two.found.causes.size(); ++k, ++causes) {
      EXPECT_EQ(same->found.causes[k].size, two.found.causes[k].size);
      EXPECT_EQ(same->found.causes[k].gain.total, two.found.causes[k].gain.total);
    }
  }
  EXPECT_GE(compared, 5U);
  EXPECT_GE(causes, 3U);
}

// The car slips sideways by 3 mm (standard deviation) after a metre. If the diagnosis assumes a
// smaller slip, it underestimates by a quarter the standard errors of the sensor's rotation and
// position.
TEST(DiagnosisStudy, HowTheCarCreepsSidewaysIsToldFromThePoses) {
  constexpr int kDrives = 8;
  double mean = 0.0;
  for (int i = 0; i < kDrives; ++i) {
    const test::TemporaryFolder folder;
    const auto drive = folder.path() / "drive";
    write_hidden_drive(drive, 400U + static_cast<std::uint64_t>(i), 300.0, {});
    Observations obs = observe(motion_streams(Drive::open(drive)));
    const MotionModel model = nominal_model(obs);
    mean += model.noise.creep_per_sqrt_m / kDrives;
  }
  // The mean is one standard error (a sixth) above the true value, and the bounds allow about as
  // much to either side.
  EXPECT_GT(mean, 0.0029);
  EXPECT_LT(mean, 0.0042);
}

// The drive is two rounds of the car park on its hinged floor, where the scanner tilts. The beams
// themselves cause errors of the map. The diagnosis must not name these errors as crosstalk, and it
// must find a hidden share of wrong readings.
TEST(DiagnosisStudy, ReadingsOfTheSimulatedCarParkHaveTheCauseThatWasHidden) {
  const test::TemporaryFolder folder;
  DiagnosisStudyOptions options;
  options.folder = folder.path();
  options.seed = 3;
  options.drives_an_effect = 1;
  options.null_drives = 1;
  options.removed_an_effect = 0;
  options.only = "range0.short,detector.foot_point";
  const auto drives = run_diagnosis_study(options);
  ASSERT_EQ(drives.size(), 4U);
  for (const StudiedDrive& drive : drives) {
    if (drive.effect.empty()) {
      EXPECT_EQ(drive.answer(), "nothing");
      continue;
    }
    EXPECT_TRUE(options.only.find(drive.effect) != std::string::npos) << drive.effect;
    EXPECT_TRUE(drive.named_first()) << drive.answer() << " for " << drive.size;
    EXPECT_GT(drive.oracle.gain, 0.0);
    EXPECT_GT(drive.oracle.strength, 6.0);
  }
}

Diagnosis diagnosed(std::uint64_t seed, const EffectSizes& hidden) {
  const test::TemporaryFolder folder;
  write_hidden_drive(folder.path() / "drive", seed, 300.0, hidden);
  DriveOptions options;
  options.num_threads = 1;
  return diagnose(motion_streams(Drive::open(folder.path() / "drive", options)), "drive");
}

std::vector<std::string> names_of(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const FoundCause& cause : d.causes) names.push_back(cause.effect);
  for (const UnknownCause& u : d.unknown) names.push_back("unknown: " + u.hook);
  return names;
}

// The delay is far from the nominal drive. There, two generic terms about poses together score
// higher than the single correct name. The correct name still scores higher than each term alone.
TEST(DiagnosisStudy, ALongDelayOfPosesIsOneNameNotTwoTermsAlsoBesideAnotherCause) {
  const auto seed_of = [](const char* what, std::uint64_t i) {
    return Random(2026112199, std::string("diagnosis study ") + what, i);
  };
  const std::uint64_t alone = seed_of("cam.latency", 5)() >> 1U;
  EXPECT_EQ(names_of(diagnosed(alone, {{"cam.latency", -0.0795}})),
            std::vector<std::string>{"cam.latency"});
  Random pair = seed_of("pair", 66);
  (void)pair.below(28);
  (void)pair.below(27);
  const EffectSizes both{{"imu0.gyro_scale", 0.01087}, {"cam.latency", -0.01841}};
  EXPECT_EQ(names_of(diagnosed(pair() >> 1U, both)),
            (std::vector<std::string>{"imu0.gyro_scale", "cam.latency"}));
}

// A time shift changes the readings nonlinearly: along the straight line from the fit back to zero
// drift, the gain is a quarter smaller.
TEST(DiagnosisStudy, AClockThatDriftsGainsWhatOneWhoKnowsItWouldGain) {
  const EffectSizes hidden{{"clock.drift", 9e-5}};
  const test::TemporaryFolder folder;
  write_hidden_drive(folder.path() / "drive", 1, 300.0, hidden);
  DriveOptions options;
  options.num_threads = 1;
  const MotionStreams streams = motion_streams(Drive::open(folder.path() / "drive", options));
  const Diagnosis found = diagnose(streams, "drive");
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes[0].effect, "clock.drift");
  const double known = ask_oracle(streams, hidden).gain;
  EXPECT_GT(found.causes[0].gain.total, 0.93 * known);
  EXPECT_LT(found.causes[0].gain.total, 1.03 * known);
}

}  // namespace
}  // namespace roadbook
