#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "diagnosis/map_diagnosis.hpp"
#include "diagnosis/streams/drive_session.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/diagnosis/hidden_views/study_case.hpp"
#include "tests/mapping/store/small_map.hpp"

// Late images and early wheels are confounded in the views of a map; a third clock separates them.

namespace roadbook::test {
namespace {

// The seed decides which of the two clocks is wrong and by how much.
HiddenViewOptions with_a_late_clock(std::uint64_t seed) {
  Random random(seed, "late clock");
  HiddenViewOptions o;
  o.seed = seed;
  o.length_m = 60.0;
  o.outliers = 0.0;
  const double size = random.uniform(0.02, 0.05) * (random.uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0);
  o.secret[seed % 2 == 0 ? "cam.latency" : "wheels0.latency"] = size;
  return o;
}

Diagnosis diagnosis_in(const std::filesystem::path& folder, const EffectSizes& known = {}) {
  const Drive drive = Drive::open(folder / "drive");
  DiagnosisOptions options;
  options.known = known;
  return diagnose_through_map(load_map(folder / "map.gpkg"), 0, drive, options);
}

std::vector<FoundCause> of_readings(const Diagnosis& d) {
  std::vector<FoundCause> causes = d.causes;
  std::erase_if(causes, [](const FoundCause& c) { return c.noise; });
  return causes;
}

void expect_that_clock_alone(const HiddenViewOptions& hidden, const std::string& witness) {
  const Folder folder;
  write_hidden_views(hidden, folder / "views");
  const Diagnosis d = diagnosis_in(folder / "views");
  const auto& [name, size] = *hidden.secret.begin();
  const auto causes = of_readings(d);
  ASSERT_EQ(causes.size(), 1U) << causes.back().effect;
  EXPECT_TRUE(d.unknown.empty());
  EXPECT_EQ(causes[0].effect, name);
  EXPECT_NEAR(causes[0].size, size, causes[0].high - causes[0].low);
  EXPECT_TRUE(causes[0].inseparable.empty()) << causes[0].inseparable.front();
  // Wheels against a reference are more informative about wheel effects than views.
  const std::string told = "separated from wheels0.latency by " + witness;
  EXPECT_TRUE(name != "cam.latency" || causes[0].note.find(told) != std::string::npos);
  ASSERT_EQ(d.extended.size(), 1U);
  EXPECT_EQ(d.extended.begin()->first, name);
  const Diagnosis again = diagnosis_in(folder / "views", d.extended);
  for (const FoundCause& c : of_readings(again)) ADD_FAILURE() << c.effect << " " << c.size;
  EXPECT_TRUE(again.unknown.empty());
}

TEST(HiddenClocks, ReferencePosesTellLateImagesFromEarlyWheels) {
  for (const std::uint64_t seed : {302U, 303U}) {  // late images with a gyro, late wheels without
    SCOPED_TRACE(seed);
    HiddenViewOptions hidden = with_a_late_clock(seed);
    hidden.reference = true;
    hidden.imu = seed < 303;
    expect_that_clock_alone(hidden, "the reference poses");
  }
}

TEST(HiddenClocks, WithoutThemTheGyroDoesAndOneDelayIsOneName) {
  for (std::uint64_t seed = 311; seed <= 312; ++seed) {
    SCOPED_TRACE(seed);
    expect_that_clock_alone(with_a_late_clock(seed), "the gyro");
  }
}

TEST(HiddenClocks, WithoutAThirdClockBothStandInTheSetAndTheDriveThatTellsIsNamed) {
  HiddenViewOptions hidden = with_a_late_clock(322);
  hidden.imu = false;
  const Folder folder;
  write_hidden_views(hidden, folder / "views");
  const auto causes = of_readings(diagnosis_in(folder / "views"));
  ASSERT_EQ(causes.size(), 1U);
  std::vector<std::string> set = causes[0].inseparable;
  set.push_back(causes[0].effect);
  std::sort(set.begin(), set.end());
  EXPECT_EQ(set, (std::vector<std::string>{"cam.latency", "wheels0.latency"}));
  EXPECT_NE(causes[0].separating.find("gyro or reference poses"), std::string::npos);
}

TEST(HiddenClocks, ThatAreRightRaiseNoAlarm) {
  for (const bool reference : {false, true}) {
    HiddenViewOptions hidden = with_a_late_clock(331);
    hidden.secret.clear();
    hidden.reference = reference;
    const Folder folder;
    write_hidden_views(hidden, folder / "views");
    for (const FoundCause& c : of_readings(diagnosis_in(folder / "views")))
      ADD_FAILURE() << c.effect << " " << c.size;
  }
}

}  // namespace
}  // namespace roadbook::test
