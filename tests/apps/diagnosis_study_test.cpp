#include "apps/diagnosis_study.hpp"

#include <gtest/gtest.h>

#include "tests/drive/drive_fixture.hpp"

namespace roadbook {
namespace {

std::vector<StudiedDrive> study(int threads, const std::filesystem::path& folder) {
  DiagnosisStudyOptions options;
  options.folder = folder / std::to_string(threads);
  options.seed = 12;
  options.drives_an_effect = 1;
  options.null_drives = 3;
  options.readings = false;
  options.length_m = 100.0;
  options.num_threads = threads;
  return run_diagnosis_study(options);
}

// The simulation's own car as the one who hides: strong effects are named, nothing else is, and
// two threads say what one says, to the last bit.
TEST(DiagnosisStudy, StrongEffectsAreNamedAndThreadsDoNotMatter) {
  const test::TemporaryFolder folder;
  const auto one = study(1, folder.path());
  const auto two = study(2, folder.path());
  ASSERT_EQ(one.size(), two.size());
  DiagnosisScore score;
  for (std::size_t i = 0; i < one.size(); ++i) {
    SCOPED_TRACE(one[i].effect);
    EXPECT_EQ(one[i].answer(), two[i].answer());
    ASSERT_EQ(one[i].found.causes.size(), two[i].found.causes.size());
    for (std::size_t k = 0; k < one[i].found.causes.size(); ++k) {
      EXPECT_EQ(one[i].found.causes[k].size, two[i].found.causes[k].size);
      EXPECT_EQ(one[i].found.causes[k].gain.total, two[i].found.causes[k].gain.total);
    }
    if (one[i].effect.empty()) {
      EXPECT_EQ(one[i].answer(), "nothing");
    } else {
      score.add(one[i]);
    }
  }
  EXPECT_GE(score.strong, 8U);
  EXPECT_GE(score.strong_in_set + 1, score.strong);
  EXPECT_LE(score.wrong, 1U);
}

// Two rounds of the car park on its hinged floor, where the scanner tilts: errors of the map that
// the beams themselves make must not look like crosstalk, and a share that was hidden is found.
TEST(DiagnosisStudy, ReadingsOfTheSimulatedCarParkHaveTheCauseThatWasHidden) {
  const test::TemporaryFolder folder;
  for (const char* effect : {"range0.short", "detector.foot_point"}) {
    DiagnosisStudyOptions options;
    options.folder = folder.path() / effect;
    options.seed = 3;
    options.drives_an_effect = 1;
    options.null_drives = 1;
    options.only = effect;
    const auto drives = run_diagnosis_study(options);
    ASSERT_EQ(drives.size(), 2U);
    EXPECT_TRUE(drives[0].named_first()) << drives[0].answer() << " for " << drives[0].size;
    EXPECT_GT(drives[0].oracle.gain, 0.0);
    EXPECT_GT(drives[0].oracle.strength, 6.0);
    EXPECT_EQ(drives[1].answer(), "nothing");
  }
}

}  // namespace
}  // namespace roadbook
