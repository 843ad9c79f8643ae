#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "tests/diagnosis/hidden_effects/reading_study_cases.hpp"

namespace roadbook::test {
namespace {

std::filesystem::path folder_of(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("roadbook_readings_" + name);
}

ReadingOutcome hidden_friction(const std::string& effect, double size, std::uint64_t seed) {
  FrictionSecret hidden;
  hidden.seed = seed;
  if (size != 0.0) hidden.secret[effect] = size;
  return run_friction(hidden, folder_of("friction" + effect));
}

ReadingOutcome hidden_range(const std::string& effect, double size, std::uint64_t seed) {
  RangeSecret hidden;
  hidden.seed = seed;
  if (size != 0.0) hidden.secret[effect] = size;
  return run_range(hidden, folder_of("range" + effect));
}

template <typename Write>
Diagnosis diagnosed_with(const EffectSizes& known, const Write& write) {
  write(folder_of("known"));
  const Drive drive = Drive::open(folder_of("known"));
  return diagnose_readings(drive_readings(drive, motion_streams(drive).poses), {}, {}, known);
}

struct Case {
  const char* effect;
  double size;
};
constexpr Case kFriction[] = {{"friction0.slip_bias", -0.1},     {"friction0.speed_bias", 0.004},
                              {"friction0.drying", 6e-5},        {"friction0.temperature", 0.003},
                              {"friction0.extra_class", -0.2},   {"friction0.spatial_bias", 0.05},
                              {"friction0.outliers", 0.05},      {"friction0.variance(speed)", 0.2},
                              {"friction0.variance(turn)", 4.0}, {"friction0.correlation", 0.5}};
constexpr Case kRange[] = {{"range0.short", 0.05},          {"range0.maximum", 0.04},
                           {"range0.crosstalk", 0.05},      {"range0.outliers", 0.03},
                           {"range0.variance(speed)", 0.5}, {"range0.variance(turn)", 4.0},
                           {"range0.correlation", 0.5}};

class HiddenFriction : public ::testing::TestWithParam<Case> {};

TEST_P(HiddenFriction, IsNamedWithItsSize) {
  const Case& c = GetParam();
  const ReadingOutcome o = hidden_friction(c.effect, c.size, 11);
  EXPECT_TRUE(o.named_first(c.effect)) << o.to_line();
  const FoundCause* cause = o.cause(c.effect);
  ASSERT_NE(cause, nullptr) << o.to_line();
  // Three standard errors.
  EXPECT_NEAR(cause->size, c.size, 3.0 / 3.92 * (cause->high - cause->low)) << o.to_line();
}

INSTANTIATE_TEST_SUITE_P(Each, HiddenFriction, ::testing::ValuesIn(kFriction));

TEST(HiddenReadings, NothingIsNamedWhereNothingIsHidden) {
  EXPECT_TRUE(hidden_friction("", 0.0, 1).silent());
  EXPECT_TRUE(hidden_range("", 0.0, 1).silent());
}

TEST(HiddenReadings, EachShareOfTheBeamModelAndEachFaultOfItsNoiseIsNamedWithItsSize) {
  for (const Case& c : kRange) {
    const ReadingOutcome o = hidden_range(c.effect, c.size, 5);
    EXPECT_TRUE(o.named_first(c.effect)) << o.to_line();
    EXPECT_EQ(o.found.causes.size(), 1U) << o.to_line();
    const FoundCause* cause = o.cause(c.effect);
    ASSERT_NE(cause, nullptr);
    EXPECT_NEAR(cause->size, c.size, 3.0 / 3.92 * (cause->high - cause->low)) << o.to_line();
    EXPECT_GT(cause->gain.low, 0.0);
  }
}

// Two discs of the same size, which a smooth spatial bias would explain as well.
TEST(HiddenReadings, TwoResurfacedPlacesAreTwoPlacesOfOneName) {
  for (const double size : {-0.2, -0.1}) {
    FrictionSecret hidden;
    hidden.seed = 14;
    hidden.resurfaced = 2;
    hidden.secret["friction0.extra_class"] = size;
    const ReadingOutcome o = run_friction(hidden, folder_of("surfaces"));
    SCOPED_TRACE(o.to_line());
    ASSERT_EQ(o.found.causes.size(), 2U);
    for (const FoundCause& cause : o.found.causes) {
      EXPECT_EQ(cause.effect, "friction0.extra_class");
      EXPECT_NEAR(cause.size, size, 3.0 / 3.92 * (cause.high - cause.low));
    }
    EXPECT_NE(o.found.causes[0].note, o.found.causes[1].note);
    EXPECT_TRUE(o.found.unknown.empty());
  }
}

// A wrong model: the readings give the difference with its sign.
TEST(HiddenReadings, AModelThatTheReadingsContradictIsSaidToBeWrong) {
  const EffectSizes of_friction{{"friction0.slip_bias", 0.1}};
  const EffectSizes of_range{{"range0.short", 0.05}, {"range0.crosstalk", 0.03}};
  FrictionSecret friction;
  RangeSecret range;
  friction.seed = range.seed = 4;
  for (const EffectSizes& wrong : {of_friction, of_range}) {
    const Diagnosis d = diagnosed_with(wrong, [&](const std::filesystem::path& folder) {
      if (wrong.contains("friction0.slip_bias"))
        write_friction_drive(friction, folder);
      else
        write_range_drive(range, folder);
    });
    ASSERT_EQ(d.causes.size(), wrong.size());
    for (const FoundCause& cause : d.causes) {
      const double known = wrong.at(cause.effect);
      EXPECT_NEAR(cause.size, -known, 0.1 * known + 3.0 / 3.92 * (cause.high - cause.low));
      EXPECT_NE(cause.note.find("in addition to the known size"), std::string::npos);
      EXPECT_NEAR(d.extended.at(cause.effect), known + cause.size, 1e-12);
    }
  }
}

TEST(HiddenReadings, WrongLabelsDoNotHideABiasOfSlip) {
  FrictionSecret hidden;
  hidden.seed = 21;
  hidden.secret["friction0.slip_bias"] = 0.15;
  hidden.wrong_labels = 0.02;
  const ReadingOutcome o = run_friction(hidden, folder_of("labels"));
  const FoundCause* cause = o.cause("friction0.slip_bias");
  ASSERT_NE(cause, nullptr) << o.to_line();
  EXPECT_NEAR(cause->size, 0.15, 3.0 / 3.92 * (cause->high - cause->low)) << o.to_line();
}

TEST(HiddenReadings, WithoutATemperatureThatIsSaid) {
  FrictionSecret hidden;
  hidden.seed = 3;
  hidden.temperature = false;
  const ReadingOutcome o = run_friction(hidden, folder_of("cold"));
  ASSERT_FALSE(o.found.notes.empty());
  EXPECT_NE(o.found.notes.front().find("no temperature is logged"), std::string::npos);
}

// Without labels the surfaces are inferred from their friction. The slip bias is still found, and
// the report says which effects need labels.
TEST(HiddenReadings, WithoutLabelsOfTheGroundABiasOfSlipIsFound) {
  FrictionSecret hidden;
  hidden.seed = 22;
  hidden.surface = false;
  hidden.secret["friction0.slip_bias"] = 0.15;
  const ReadingOutcome o = run_friction(hidden, folder_of("unlabelled"));
  const FoundCause* cause = o.cause("friction0.slip_bias");
  ASSERT_NE(cause, nullptr) << o.to_line();
  EXPECT_NEAR(cause->size, 0.15, 3.0 / 3.92 * (cause->high - cause->low)) << o.to_line();
  ASSERT_FALSE(o.found.notes.empty());
  EXPECT_NE(o.found.notes.front().find("no column `surface`"), std::string::npos);
  EXPECT_EQ(o.cause("friction0.spatial_bias"), nullptr);
  hidden.secret.clear();
  const ReadingOutcome nothing = run_friction(hidden, folder_of("unlabelled"));
  EXPECT_EQ(nothing.cause("friction0.slip_bias"), nullptr) << nothing.to_line();
}

}  // namespace
}  // namespace roadbook::test
