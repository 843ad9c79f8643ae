#include <gtest/gtest.h>

#include <string>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/motion/closed_form_start.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"

namespace roadbook {
namespace {

MotionStreams recorded_with(std::uint64_t seed, const test::Secret& secret = {}) {
  test::HiddenDriveOptions hidden;
  hidden.seed = seed;
  hidden.length_m = 200.0;
  hidden.secret = secret;
  MotionStreams streams = test::streams_of(test::record_drive(hidden));
  // Removes the standstill at both ends.
  constexpr std::ptrdiff_t kEnds = 75;
  streams.poses.erase(streams.poses.end() - kEnds, streams.poses.end());
  streams.poses.erase(streams.poses.begin(), streams.poses.begin() + kEnds);
  return streams;
}

template <typename Sample>
void delay(std::vector<Sample>& stream, double by_s) {
  for (Sample& s : stream) s.t_s += by_s;
}

// The recording with the stamps of one clock shifted.
MotionStreams late(const std::string& effect, double by_s, std::uint64_t seed) {
  MotionStreams streams = recorded_with(seed);
  if (effect == "imu0.latency") delay(streams.gyro, by_s);
  if (effect == "wheels0.latency") delay(streams.wheels, by_s);
  if (effect == "cam.latency") delay(streams.poses, by_s);
  if (effect == "wheels0.latency" || effect == "steering0.latency") delay(streams.steering, by_s);
  return streams;
}

void expect_nothing(const Diagnosis& d) {
  for (const FoundCause& c : d.causes) ADD_FAILURE() << c.effect << " " << c.size;
  for (const UnknownCause& u : d.unknown) ADD_FAILURE() << u.hook << " ~ " << u.depends_on;
}

// Half a millisecond of tolerance for the position of stamps between knots.
constexpr double kBetweenKnots = 1e-3;

class GrossLatency : public testing::TestWithParam<const char*> {};

TEST_P(GrossLatency, OfSecondsIsNamedAloneWithItsSizeAndLeavesNothing) {
  for (const double size : {-4.5, 0.8}) {
    SCOPED_TRACE(size);
    const MotionStreams streams = late(GetParam(), size, 3);
    const Diagnosis d = diagnose(streams, "late");
    ASSERT_EQ(d.causes.size(), 1U);
    EXPECT_TRUE(d.unknown.empty());
    const FoundCause& cause = d.causes[0];
    EXPECT_EQ(cause.effect, GetParam());
    EXPECT_NEAR(cause.size, size, 0.75 * (cause.high - cause.low) + kBetweenKnots);
    EXPECT_LT(cause.high - cause.low, 0.004);
    EXPECT_TRUE(cause.inseparable.empty());
    DiagnosisOptions again;
    again.known = d.extended;
    expect_nothing(diagnose(streams, "again", again));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Streams,
    GrossLatency,
    testing::Values("imu0.latency", "wheels0.latency", "steering0.latency", "cam.latency"),
    [](const auto& stream) {
      const std::string name = stream.param;
      return name.substr(0, name.find('.'));
    });

TEST(GrossLatencies, OfTwoClocksAreToldApart) {
  MotionStreams streams = recorded_with(4);
  delay(streams.gyro, -3.1);
  delay(streams.wheels, 1.0);
  delay(streams.steering, 1.0);
  const Diagnosis d = diagnose(streams, "two clocks");
  ASSERT_EQ(d.causes.size(), 2U);
  EXPECT_NEAR(d.extended.at("imu0.latency"), -3.1, 2e-3);
  EXPECT_NEAR(d.extended.at("wheels0.latency"), 1.0, 2e-3);
}

TEST(GrossLatencies, BesideAnotherCauseAndAGrossFactor) {
  MotionStreams streams = recorded_with(5, {{"wheels0.left_radius", 0.01}});
  delay(streams.wheels, 1.7);
  delay(streams.steering, 1.7);
  const Diagnosis d = diagnose(streams, "radius");
  ASSERT_EQ(d.causes.size(), 2U);
  EXPECT_NEAR(d.extended.at("wheels0.latency"), 1.7, 3e-3);
  EXPECT_NEAR(d.extended.at("wheels0.left_radius"), 0.01, 1e-3);

  streams = recorded_with(5, {{"imu0.gyro_scale", 1.0}});
  delay(streams.gyro, -1.7);
  const EffectSizes start = start_of_large_effects(observe(streams), {}, {});
  ASSERT_EQ(start.size(), 2U);
  EXPECT_NEAR(start.at("imu0.latency"), -1.7, 0.02);
  EXPECT_NEAR(start.at("imu0.gyro_scale"), 1.0, 0.05);
}

// Without the effect of the poses' clock, the common delay is reported for each stream.
TEST(GrossLatencies, OfAllStreamsAlikeAreOfThePosesUnlessThatIsLeftOut) {
  const Observations obs = observe(late("cam.latency", 2.0, 6));
  const EffectSizes poses = start_of_large_effects(obs, {}, {});
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_NEAR(poses.at("cam.latency"), 2.0, 0.02);
  LibraryOptions library;
  library.without = {"cam.latency"};
  const EffectSizes each = start_of_large_effects(obs, {}, library);
  ASSERT_EQ(each.size(), 2U);
  EXPECT_NEAR(each.at("wheels0.latency"), -2.0, 0.02);
  EXPECT_NEAR(each.at("imu0.latency"), -2.0, 0.02);
}

// Practical sizes are found by linear steps.
TEST(GrossLatencies, AreNoneWhereClocksAgreeToATenthOfASecond) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    EXPECT_TRUE(start_of_large_effects(observe(recorded_with(seed)), {}, {}).empty());
    EXPECT_TRUE(start_of_large_effects(observe(late("imu0.latency", 0.1, seed)), {}, {}).empty());
  }
}

}  // namespace
}  // namespace roadbook
