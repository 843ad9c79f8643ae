#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "tests/diagnosis/hidden_effects/reading_study_cases.hpp"

namespace roadbook::test {
namespace {

ReadingOutcome hidden(const std::string& name,
                      std::uint64_t seed,
                      const Secret& secret,
                      const std::vector<std::string>& without = {}) {
  DetectorSecret drive;
  drive.seed = seed;
  drive.secret = secret;
  return run_detector(drive, std::filesystem::temp_directory_path() / ("roadbook_detector_" + name),
                      without);
}

void expect_size(const ReadingOutcome& o, const std::string& effect, double size) {
  const FoundCause* cause = o.cause(effect);
  ASSERT_NE(cause, nullptr) << o.to_line();
  // Three standard errors.
  EXPECT_NEAR(cause->size, size, 3.0 / 3.92 * (cause->high - cause->low)) << o.to_line();
  EXPECT_GT(cause->gain.total, 0.0) << o.to_line();
}

// Effect, sign and size from the seed; nothing but files passes.
TEST(HiddenDetector, ABiasOfTheFeetIsNamedWithSizeAndSign) {
  const EffectRange& range = detector_ranges()[1];
  ASSERT_EQ(range.name, "detector.foot_point");
  for (std::uint64_t seed = 11; seed < 17; ++seed) {
    const double size = draw_size(range, seed);
    const ReadingOutcome o = hidden("feet", seed, {{range.name, size}});
    EXPECT_TRUE(o.named_first(range.name)) << o.to_line();
    EXPECT_EQ(o.found.causes.size() + o.found.unknown.size(), 1U) << o.to_line();
    expect_size(o, range.name, size);
  }
}

TEST(HiddenDetector, ARecallThatFallsWithRangeIsNamedWithItsSize) {
  for (std::uint64_t seed = 21; seed < 24; ++seed) {
    const ReadingOutcome o = hidden("range", seed, {{"detector.range", 0.4}});
    EXPECT_TRUE(o.named_first("detector.range")) << o.to_line();
    expect_size(o, "detector.range", 0.4);
  }
}

TEST(HiddenDetector, BothAtOnceAreNamed) {
  const ReadingOutcome o =
      hidden("both", 31, {{"detector.range", 0.4}, {"detector.foot_point", -0.2}});
  expect_size(o, "detector.range", 0.4);
  expect_size(o, "detector.foot_point", -0.2);
}

TEST(HiddenDetector, NothingIsNamedWhereNothingIsHidden) {
  for (std::uint64_t seed = 41; seed < 49; ++seed) {
    const ReadingOutcome o = hidden("null", seed, {});
    EXPECT_TRUE(o.silent()) << o.to_line();
  }
}

TEST(HiddenDetector, WithoutItsNameTheDependenceIsSaid) {
  const ReadingOutcome feet =
      hidden("nameless", 51, {{"detector.foot_point", 0.3}}, {"detector.foot_point"});
  EXPECT_TRUE(feet.found.causes.empty()) << feet.to_line();
  ASSERT_FALSE(feet.found.unknown.empty()) << feet.to_line();
  EXPECT_EQ(feet.found.unknown.front().hook, "along");
  EXPECT_EQ(feet.found.unknown.front().depends_on, "constant");
  const ReadingOutcome recall =
      hidden("nameless", 52, {{"detector.range", 0.5}}, {"detector.range"});
  EXPECT_TRUE(recall.found.causes.empty()) << recall.to_line();
  ASSERT_FALSE(recall.found.unknown.empty()) << recall.to_line();
  EXPECT_EQ(recall.found.unknown.front().hook, "found");
  EXPECT_EQ(recall.found.unknown.front().depends_on, "range");
}

// A camera with a pitch error places pedestrians too far by a multiple of the squared range; late
// stamps place them where the car was. Neither is in the catalogue.
TEST(HiddenDetector, WhatNobodyListedIsUnknownWithHookAndCovariate) {
  const ReadingOutcome pitch = hidden("pitch", 61, {{"pitch", 0.02}});
  EXPECT_TRUE(pitch.found.causes.empty()) << pitch.to_line();
  ASSERT_FALSE(pitch.found.unknown.empty()) << pitch.to_line();
  EXPECT_EQ(pitch.found.unknown.front().hook, "along");
  EXPECT_EQ(pitch.found.unknown.front().depends_on, "range");
  const ReadingOutcome late = hidden("late", 62, {{"late", 0.2}});
  EXPECT_TRUE(late.found.causes.empty()) << late.to_line();
  ASSERT_FALSE(late.found.unknown.empty()) << late.to_line();
  EXPECT_EQ(late.found.unknown.front().hook, "time");
  ASSERT_EQ(late.found.unknown.front().terms.size(), 1U);
  EXPECT_GT(late.found.unknown.front().terms.front(), 0.0);
}

TEST(HiddenDetector, WithoutATableOfLooksNothingIsSaidOfWhoWasMissed) {
  DetectorSecret drive;
  drive.seed = 71;
  drive.looks = false;
  drive.secret = {{"detector.range", 0.5}, {"detector.foot_point", 0.2}};
  const ReadingOutcome o =
      run_detector(drive, std::filesystem::temp_directory_path() / "roadbook_detector_looks");
  EXPECT_EQ(o.cause("detector.range"), nullptr) << o.to_line();
  EXPECT_NE(o.cause("detector.foot_point"), nullptr) << o.to_line();
  ASSERT_FALSE(o.found.notes.empty());
  EXPECT_NE(o.found.notes.back().find("looks.csv"), std::string::npos) << o.found.notes.back();
}

// The model is wrong: the drive has no hidden effect, so the fitted size has the opposite sign.
TEST(HiddenDetector, AModelThatTheSightingsContradictIsSaidToBeWrong) {
  const auto folder = std::filesystem::temp_directory_path() / "roadbook_detector_known";
  DetectorSecret hidden;
  hidden.seed = 12;
  write_detector_drive(hidden, folder);
  const Drive drive = Drive::open(folder);
  const DriveReadings readings = drive_readings(drive, motion_streams(drive).poses);
  for (const EffectSizes& wrong :
       {EffectSizes{{"detector.foot_point", 0.3}}, EffectSizes{{"detector.range", 0.3}}}) {
    const Diagnosis d = diagnose_readings(readings, {}, {}, wrong);
    const auto& [name, size] = *wrong.begin();
    ASSERT_EQ(d.causes.size(), 1U) << name;
    EXPECT_EQ(d.causes[0].effect, name);
    EXPECT_NEAR(d.causes[0].size, -size, 3.0 / 3.92 * (d.causes[0].high - d.causes[0].low));
    EXPECT_NEAR(d.extended.at(name), 0.0, d.causes[0].high - d.causes[0].low);
  }
}

}  // namespace
}  // namespace roadbook::test
