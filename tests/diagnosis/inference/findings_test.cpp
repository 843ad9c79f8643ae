#include "diagnosis/inference/findings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "diagnosis/inference/check_notes.hpp"
#include "diagnosis/inference/plausible_size.hpp"
#include "diagnosis/reading_diagnosis.hpp"

namespace roadbook {
namespace {

Diagnosis of(std::vector<std::string> looked_for, std::vector<std::string> not_observable) {
  Diagnosis d;
  d.looked_for = std::move(looked_for);
  d.not_observable = std::move(not_observable);
  return d;
}

TEST(Findings, WhatOneOfTwoDrivesShowsIsObservableAndWhatNoneDoesIsSaidOnce) {
  const Diagnosis one = of({"a", "b", "c"}, {"a", "b"});
  const Diagnosis other = of({"a", "b", "d"}, {"a", "d"});
  for (const bool swapped : {false, true}) {
    Diagnosis all = swapped ? other : one;
    add_findings(swapped ? one : other, all);
    EXPECT_EQ(all.not_observable, (std::vector<std::string>{"a", "d"}));
    EXPECT_EQ(all.looked_for.size(), 4U);
  }
}

// One channel has its check, one has too few rows, one was not read.
TEST(Findings, WhatWasReadAndHasNoCheckIsSaid) {
  const std::vector<ChannelName> channels{
      {"poses", "along"}, {"wheels0", "distance"}, {"imu0", "yaw_rate"}};
  Innovations left;
  left.of.resize(2);
  left.of[1].channel = 1;
  ChannelCheck along;
  along.stream = "poses";
  along.channel = "along";
  along.scale = 1.0;
  std::vector<std::string> notes = check_notes(channels, left, {along});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(notes[0].starts_with("no residual checks of wheels0 (distance): ")) << notes[0];
  along.scale = 0.3;
  notes = check_notes(channels, left, {along});
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_TRUE(notes[1].starts_with("checks: poses (along) have a scale below 1, ")) << notes[1];
}

// Two puddles of one drive; a radius that motion and views both show.
TEST(Findings, PlacesOfOneNameAreNotOneAndAnEffectInTwoKindsOfDataIs) {
  const auto cause = [](const char* effect, double size, double half, bool in_place) {
    FoundCause c;
    c.effect = effect;
    c.size = size;
    c.low = size - half;
    c.high = size + half;
    c.in_place = in_place;
    return c;
  };
  Diagnosis views, motion;
  views.causes = {cause("wheels0.radius", 0.021, 0.002, false)};
  motion.causes = {cause("wheels0.wet_patch", 0.06, 0.01, true),
                   cause("wheels0.wet_patch", 0.12, 0.02, true),
                   cause("wheels0.radius", 0.020, 0.001, false)};
  const std::array<Diagnosis, 2> parts{views, motion};
  std::vector<double> sizes;
  for (const FoundCause& c : merged(parts).causes) sizes.push_back(c.size);
  std::sort(sizes.begin(), sizes.end());
  EXPECT_EQ(sizes, (std::vector<double>{0.020, 0.06, 0.12}));
}

// Gyro rates in degrees are 57.3 times too large; a radius stated as a diameter is half of it.
TEST(LikelyMistake, IsAskedWhereASizeIsThatOfAUsualOne) {
  EXPECT_EQ(likely_mistake("imu0.gyro_scale", -2.0), "sign reversed?");
  EXPECT_EQ(likely_mistake("imu0.gyro_scale", 56.3), "degrees taken for radians?");
  EXPECT_EQ(likely_mistake("steering0.ratio", -0.9825), "radians taken for degrees?");
  EXPECT_EQ(likely_mistake("wheels0.radius", -0.5), "diameter stated for the radius?");
  EXPECT_EQ(likely_mistake("wheels0.radius", 1.0), "half the radius stated?");
  EXPECT_EQ(likely_mistake("wheels0.radius", 2.6), "m/s taken for km/h?");
  EXPECT_EQ(likely_mistake("imu0.gyro_scale", 0.02), "");
  EXPECT_EQ(likely_mistake("imu0.gyro_scale", 1.0), "");
  EXPECT_EQ(likely_mistake("imu0.gyro_bias", -2.0), "");
  FoundCause cause;
  cause.effect = "imu0.gyro_scale";
  cause.size = -2.0;
  EXPECT_TRUE(size_doubt(cause).ends_with("; sign reversed?"));
}

}  // namespace
}  // namespace roadbook
