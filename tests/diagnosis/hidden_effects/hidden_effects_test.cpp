#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "base/random.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"
#include "tests/diagnosis/hidden_effects/seed_of_today.hpp"
#include "tests/diagnosis/hidden_effects/study_cases.hpp"
#include "tests/drive/drive_fixture.hpp"
#include "tests/support/diagnosis_outcome.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook::test {
namespace {

HiddenDriveOptions draw(std::uint64_t seed, std::uint64_t index) {
  Random random(seed, "hidden drive", index);
  HiddenDriveOptions options;
  options.seed = random() >> 1U;
  const auto& ranges = practical_ranges();
  const EffectRange& range = ranges[random.below(ranges.size())];
  options.secret[range.name] = draw_size(range, options.seed);
  return options;
}

// The date selects effect, size, sign and route. The diagnosis may miss a weak effect, but each
// effect that it names must be right. The test allows one miss of six. At the required 98 % of
// correct results, two misses of six happen in less than one of a hundred and fifty days.
TEST(HiddenEffects, WhatIsHiddenOnDiskIsNamedWithItsSizeAndItsGain) {
  const std::uint64_t seed = seed_of_today();
  int misses = 0;
  for (std::uint64_t i = 0; i < 6; ++i) {
    const TemporaryFolder folder;
    const Outcome outcome = run_hidden(draw(seed, i), folder.path() / "drive");
    const auto& [effect, size] = *outcome.hidden.secret.begin();
    SCOPED_TRACE(outcome.to_line());
    if (outcome.found.causes.empty() && outcome.found.unknown.empty() && outcome.strength < 8.0)
      continue;
    if (!outcome.in_set(effect)) {
      ++misses;
      std::cout << "miss: " << outcome.to_line() << "\n";
      continue;
    }
    const FoundCause& first = outcome.found.causes.front();
    EXPECT_GT(first.gain.total, 0.0);
    EXPECT_LT(first.p, 0.01);
    if (first.effect != effect) continue;
    EXPECT_NEAR(first.size, size, 4.0 * sigma_of(first));
    // Compares the held-out gain with that of an oracle without unknowns; noise and patches have no
    // oracle.
    if (outcome.strength == 0.0) continue;
    EXPECT_GT(first.gain.total, 0.8 * outcome.oracle_gain - 5.0);
  }
  EXPECT_LE(misses, 1);
}

// A significant effect gains as much as the oracle, also if the readings are nonlinear in its size.
TEST(HiddenEffects, OfSlipAndDelaysTheGainIsTheOracles) {
  const Secret hidden{{"wheels0.slip_acceleration", 0.009},
                      {"wheels0.latency", 0.05},
                      {"clock.drift", 1e-4},
                      {"imu0.latency", -0.04}};
  for (const auto& [effect, size] : hidden) {
    HiddenDriveOptions options;
    options.seed = 29;
    options.secret[effect] = size;
    const TemporaryFolder folder;
    const Outcome outcome = run_hidden(options, folder.path() / "drive");
    SCOPED_TRACE(outcome.to_line());
    ASSERT_TRUE(outcome.named_first(effect));
    EXPECT_NEAR(outcome.found.causes.front().gain.total / outcome.oracle_gain, 1.0, 0.04);
  }
}

// These drives have pose outliers where the car stops, where the turn per distance is undefined.
TEST(HiddenEffects, PosesThatAreFarOffWhereTheCarComesToRestAreOutliersAndNothingElse) {
  for (const auto& [seed, share] :
       {std::pair{5323005361316954131ULL, 0.0413}, std::pair{5597278578101652568ULL, 0.03936}}) {
    HiddenDriveOptions options;
    options.seed = seed;
    options.secret["poses.outliers"] = share;
    const TemporaryFolder folder;
    const Outcome outcome = diagnose_hidden(options, folder.path() / "drive");
    SCOPED_TRACE(outcome.to_line());
    EXPECT_TRUE(outcome.found.unknown.empty());
    ASSERT_EQ(outcome.found.causes.size(), 1U);
    const FoundCause& cause = outcome.found.causes.front();
    EXPECT_EQ(cause.effect, "poses.outliers");
    EXPECT_NEAR(cause.size, share, 3.0 * sigma_of(cause));
  }
}

TEST(HiddenEffects, WhereNothingIsHiddenNothingIsNamed) {
  const std::uint64_t seed = seed_of_today();
  for (std::uint64_t i = 0; i < 3; ++i) {
    HiddenDriveOptions options;
    options.seed = Random(seed, "null drive", i)() >> 1U;
    const TemporaryFolder folder;
    const Outcome outcome = diagnose_hidden(options, folder.path() / "drive");
    EXPECT_TRUE(outcome.found.causes.empty() && outcome.found.unknown.empty()) << outcome.to_line();
  }
}

// Five effects outside the catalogue are reported as unknown with the right stream and covariate.
TEST(HiddenEffects, WhatNoCatalogueListsIsUnknownWithItsHookAndCovariate) {
  for (const OutsideEffect& outside : outside_effects()) {
    HiddenDriveOptions options;
    options.seed = 2026;
    options.secret[outside.range.name] = draw_size(outside.range, 4);
    const TemporaryFolder folder;
    const Outcome outcome = diagnose_hidden(options, folder.path() / "drive");
    EXPECT_TRUE(outcome.unknown_but_right(outside)) << outcome.to_line();
  }
}

// If the true effect is not in the catalogue, a neighbour must not be named without a warning: both
// wheels for one, all other streams for a late gyro, wheels and steering for a map's scale.
TEST(HiddenEffects, ACauseThatIsTakenOutOfTheCatalogueLeavesAFlag) {
  const EffectSizes hidden{
      {"wheels0.left_radius", 0.0075}, {"imu0.latency", -0.02}, {"map.scale", -0.008}};
  for (const auto& [effect, size] : hidden) {
    HiddenDriveOptions options;
    options.seed = 2027;
    options.secret[effect] = size;
    const TemporaryFolder folder;
    const Outcome outcome = diagnose_hidden(options, folder.path() / "drive", {effect});
    EXPECT_FALSE(outcome.found.unknown.empty() && outcome.found.unexplained.empty())
        << outcome.to_line();
    EXPECT_FALSE(outcome.found.unknown.empty() && outcome.found.causes.empty())
        << outcome.to_line();
  }
}

// Reference errors correlated over a second are worth fewer independent poses: the interval widens
// and nothing false is named.
TEST(HiddenEffects, ReferencePosesWhoseErrorsGoOnInventNothingAndWidenTheInterval) {
  HiddenDriveOptions hidden;
  hidden.seed = 8;
  hidden.secret["cam.rotation"] = 0.01;
  const auto width = [&](const Diagnosis& d) { return d.causes[0].high - d.causes[0].low; };
  const Diagnosis white = diagnose(streams_of(record_drive(hidden)), "white");
  hidden.secret["poses.correlation"] = 0.8;
  const Diagnosis slow = diagnose(streams_of(record_drive(hidden)), "slow");
  ASSERT_EQ(slow.causes.size(), 2U);
  EXPECT_TRUE(slow.unknown.empty());
  EXPECT_EQ(slow.causes[0].effect, "cam.rotation");
  EXPECT_EQ(slow.causes[1].effect, "poses.correlation");
  // Errors that correlate by 0.8 from pose to pose are worth (1 - 0.8) / (1 + 0.8) of as many; the
  // other streams hold part of the information on their own.
  EXPECT_GT(width(slow), 2.0 * width(white));
  EXPECT_LT(width(slow), 3.5 * width(white));
  EXPECT_NEAR(slow.causes[0].size, 0.01, width(slow));
}

// The number of places where wheels may slip grows with the distance; the work for each does not.
TEST(HiddenEffects, ProcessorTimeGrowsWithTheLengthAndNoFaster) {
  const auto streams_over = [](double length_m) {
    HiddenDriveOptions hidden;
    hidden.seed = 31;
    hidden.length_m = length_m;
    return streams_of(record_drive(hidden));
  };
  const auto seconds_a_row = [](const MotionStreams& streams) {
    const double start = thread_seconds();
    const std::size_t rows = diagnose(streams, "drive").samples;
    return (thread_seconds() - start) / static_cast<double>(rows);
  };
  // A row took twice the time here when every place had a separate column. Other programs only
  // increase a measured time, so the test alternates the two drives and takes the minimum of
  // several measurements.
  const MotionStreams short_drive = streams_over(300.0);
  const MotionStreams long_drive = streams_over(2400.0);
  double of_short = 1e9, of_long = 1e9;
  for (int i = 0; i < 6 && (i < 2 || of_long > 1.5 * of_short); ++i) {
    of_short = std::min(of_short, seconds_a_row(short_drive));
    of_long = std::min(of_long, seconds_a_row(long_drive));
  }
  RecordProperty("ratio", std::to_string(of_long / of_short));
  EXPECT_LT(of_long, 1.5 * of_short);
}

// On a straight line, the scales of the wheels and of the map are equivalent. The report must state
// this.
TEST(HiddenEffects, OnAStraightDriveTheInseparableComeAsASet) {
  HiddenDriveOptions options;
  options.seed = 77;
  options.straight = true;
  options.secret["wheels0.radius"] = 0.02;
  const TemporaryFolder folder;
  const Outcome outcome = diagnose_hidden(options, folder.path() / "drive");
  ASSERT_FALSE(outcome.found.causes.empty());
  EXPECT_TRUE(outcome.in_set("wheels0.radius")) << outcome.to_line();
  EXPECT_TRUE(outcome.in_set("map.scale")) << outcome.to_line();
  EXPECT_FALSE(outcome.in_set("imu0.gyro_bias"));
  const auto& blind = outcome.found.not_observable;
  EXPECT_NE(std::find(blind.begin(), blind.end(), "wheels0.track_width"), blind.end());
}

TEST(HiddenEffects, ASecondDiagnosisWithTheExtendedModelFindsNothingLeft) {
  HiddenDriveOptions hidden;
  hidden.seed = 5;
  hidden.secret["imu0.gyro_bias"] = 0.002;
  const MotionStreams streams = streams_of(record_drive(hidden));
  const Diagnosis first = diagnose(streams, "drive");
  ASSERT_EQ(first.causes.size(), 1U);
  DiagnosisOptions options;
  options.known = first.extended;
  const Diagnosis second = diagnose(streams, "drive", options);
  EXPECT_TRUE(second.causes.empty());
  EXPECT_TRUE(second.unknown.empty());
}

// A model stores no places: an effect of one place is found again with the same size.
TEST(HiddenEffects, AWetPatchStaysOutOfTheModelAndIsFoundAgainAsItIs) {
  HiddenDriveOptions hidden;
  hidden.seed = 3;
  hidden.secret["wheels0.wet_patch"] = 0.07;
  const MotionStreams streams = streams_of(record_drive(hidden));
  const Diagnosis first = diagnose(streams, "drive");
  ASSERT_EQ(first.causes.size(), 1U);
  EXPECT_EQ(first.causes[0].effect, "wheels0.wet_patch");
  EXPECT_NE(first.causes[0].note.find("not written with --write-model"), std::string::npos);
  EXPECT_TRUE(first.extended.empty());
  DiagnosisOptions options;
  options.known = {{"wheels0.wet_patch", first.causes[0].size}};
  const Diagnosis second = diagnose(streams, "drive", options);
  ASSERT_EQ(second.causes.size(), 1U);
  EXPECT_EQ(second.causes[0].size, first.causes[0].size);
  EXPECT_EQ(second.extended, options.known);
  ASSERT_FALSE(second.notes.empty());
  EXPECT_TRUE(second.notes.back().starts_with("wheels0.wet_patch of the known model has no place"));
}

// The date selects size, radius and place. On a smooth oval, only the patch is abrupt. With
// intervals of 95 %, three misses of six happen once in 450 days. One drive of a hundred has a
// false alarm of noise. An error of 0.1 to 0.2 m at the patch's edges is 2 to 5 % of its length of
// 4 to 8 m. Without an estimate of the edges, the size is therefore less certain.
TEST(HiddenEffects, AWetPatchIsMeasuredWhateverItsRadiusIsAndNothingIsSaidBeside) {
  const std::uint64_t seed = seed_of_today();
  constexpr int kDrives = 6;
  int missed = 0;
  int beside = 0;
  double share = 0.0;
  for (std::uint64_t i = 0; i < kDrives; ++i) {
    Random random(seed, "hidden patch", i);
    HiddenDriveOptions hidden;
    hidden.seed = random() >> 1U;
    hidden.oval = true;
    hidden.puddle_radius_m = random.uniform(2.0, 4.0);
    const double size = draw_size({"wheels0.wet_patch", 0.04, 0.10}, hidden.seed);
    hidden.secret["wheels0.wet_patch"] = size;
    const Diagnosis d = diagnose(streams_of(record_drive(hidden)), "drive");
    SCOPED_TRACE("radius " + std::to_string(hidden.puddle_radius_m) + " m, size " +
                 std::to_string(size) + ": " + told(d));
    ASSERT_FALSE(d.causes.empty());
    const FoundCause& patch = d.causes.front();
    EXPECT_EQ(patch.effect, "wheels0.wet_patch");
    EXPECT_NEAR(patch.size, size, 4.0 * sigma_of(patch));
    share += sigma_of(patch) / std::abs(size) / kDrives;
    missed += size < patch.low || size > patch.high ? 1 : 0;
    beside += d.causes.size() + d.unknown.size() > 1 ? 1 : 0;
  }
  EXPECT_LE(missed, 2);
  EXPECT_LE(beside, 1);
  EXPECT_LT(share, 0.08);
}

}  // namespace
}  // namespace roadbook::test
