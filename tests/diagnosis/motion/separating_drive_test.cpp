#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/separating_causes.hpp"
#include "diagnosis/streams/manoeuvres.hpp"

namespace roadbook {
namespace {

const Manoeuvre& manoeuvre_named(const std::string& name) {
  const auto& all = manoeuvres();
  return *std::find_if(all.begin(), all.end(),
                       [&](const Manoeuvre& m) { return name.starts_with(m.name); });
}

Manoeuvre straight_on() {
  return {"", {{1.0, 0.0, 0.0}, {3.0, 3.0, 0.0}, {20.0, 3.0, 0.0}, {3.0, 0.0, 0.0}}};
}

// Readings of a car with wheels 2 % larger than stated, with usual noise.
MotionStreams with_large_wheels(const Manoeuvre& manoeuvre, std::uint64_t seed) {
  MotionStreams rates;
  const auto samples = [](auto& stream, double step_s) {
    stream.resize(2);
    stream[1].t_s = step_s;
  };
  samples(rates.poses, 0.08);
  samples(rates.wheels, 0.02);
  samples(rates.steering, 0.02);
  samples(rates.gyro, 0.01);
  MotionStreams s = streams_of(manoeuvre, rates);
  Random random(seed, "noise");
  for (auto& p : s.poses) {
    p.x += 0.02 * random.normal();
    p.y += 0.02 * random.normal();
    p.heading += 0.002 * random.normal();
  }
  for (auto& w : s.wheels) {
    w.left_rad = w.left_rad / 1.02 + 1e-3 * random.normal();
    w.right_rad = w.right_rad / 1.02 + 1e-3 * random.normal();
  }
  for (auto& a : s.steering) a.angle_rad += 2e-3 * random.normal();
  for (auto& g : s.gyro) g.rate_rad_s += 2e-3 * random.normal();
  return s;
}

Manoeuvre one_after_the_other(Manoeuvre a, const Manoeuvre& b) {
  a.legs.insert(a.legs.end(), b.legs.begin(), b.legs.end());
  return a;
}

// On a straight line the radius of the wheels and the scale of the map are confounded. The
// recommended drive separates them.
TEST(SeparatingDrive, TheRecommendedManoeuvreTellsTheCausesApart) {
  const Diagnosis straight = diagnose(with_large_wheels(straight_on(), 1), "straight");
  ASSERT_FALSE(straight.causes.empty());
  const FoundCause& cause = straight.causes.front();
  ASSERT_FALSE(cause.inseparable.empty());
  ASSERT_TRUE(cause.separating.ends_with("would separate them")) << cause.separating;

  const Manoeuvre both = one_after_the_other(straight_on(), manoeuvre_named(cause.separating));
  const Diagnosis after = diagnose(with_large_wheels(both, 2), "both");
  ASSERT_FALSE(after.causes.empty());
  EXPECT_EQ(after.causes.front().effect, "wheels0.radius");
  EXPECT_TRUE(after.causes.front().inseparable.empty()) << after.causes.front().inseparable.front();
}

// The same manoeuvre separates sets that the views of a map reported.
TEST(SeparatingDrive, OfACauseThatMotionDidNotFindIsTheSame) {
  const MotionStreams streams = with_large_wheels(straight_on(), 1);
  Diagnosis d = diagnose(streams, "straight");
  ASSERT_FALSE(d.causes.empty());
  const std::string plain = d.causes.front().separating;
  ASSERT_FALSE(plain.empty());
  d.causes.front().separating.clear();
  name_separating_drives(streams, {}, d);
  EXPECT_EQ(d.causes.front().separating, plain);
}

TEST(SeparatingDrive, OfWhatMotionDoesNotShowIsByWhatHasToVary) {
  Diagnosis d;
  FoundCause cause;
  cause.effect = "cam2.latency";
  cause.inseparable = {"cam2.rolling_shutter"};
  d.causes.push_back(cause);
  cause.effect = "cam2.focal";
  cause.inseparable = {"cam2.distortion"};
  d.causes.push_back(cause);
  name_separating_drives(with_large_wheels(straight_on(), 1), {}, d);
  EXPECT_EQ(
      d.causes[0].separating,
      "a drive in which speed and image row vary more, and independently, would separate them");
  EXPECT_EQ(d.causes[1].separating, "none of the manoeuvres tried would separate them");
}

TEST(Manoeuvres, EndAtRestAndTheirStreamsAgree) {
  for (const Manoeuvre& manoeuvre : manoeuvres()) {
    SCOPED_TRACE(manoeuvre.name);
    MotionStreams rates;
    rates.poses.resize(2);
    rates.poses[1].t_s = 0.08;
    rates.wheels.resize(2);
    rates.wheels[1].t_s = 0.02;
    rates.gyro.resize(2);
    rates.gyro[1].t_s = 0.01;
    const MotionStreams s = streams_of(manoeuvre, rates);
    EXPECT_TRUE(s.steering.empty());
    EXPECT_EQ(manoeuvre.legs.back().speed, 0.0);
    // The gyro's integral is the change of heading, the wheels' mean the way.
    double turned = 0.0;
    for (const auto& g : s.gyro) turned += 0.01 * g.rate_rad_s;
    EXPECT_NEAR(turned, s.poses.back().heading - s.poses.front().heading, 0.01);
    double way = 0.0;
    for (std::size_t i = 1; i < s.poses.size(); ++i)
      way += std::hypot(s.poses[i].x - s.poses[i - 1].x, s.poses[i].y - s.poses[i - 1].y);
    const WheelModel& model = s.wheel_model;
    EXPECT_NEAR(0.5 * (model.radius_left_m * s.wheels.back().left_rad +
                       model.radius_right_m * s.wheels.back().right_rad),
                way, 0.01 * way + 0.05);
  }
}

}  // namespace
}  // namespace roadbook
