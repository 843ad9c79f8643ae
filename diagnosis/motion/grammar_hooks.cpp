#include "diagnosis/motion/grammar_hooks.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "diagnosis/motion/columns.hpp"
#include "diagnosis/streams/motion_effects.hpp"

namespace roadbook {
namespace {

double wheel_scale(Channel channel, const MotionState& s, double dt) {
  return channel == Channel::kWheelDistance ? s.speed * dt : s.yaw_rate * dt;
}
// One wheel turning more by a share: side -1 left, +1 right.
double one_wheel(Channel channel, const WheelModel& m, const MotionState& s, double dt, int side) {
  const double rolled = (s.speed + side * 0.5 * m.track_width_m * s.yaw_rate) * dt;
  return channel == Channel::kWheelDistance ? 0.5 * rolled : side * rolled / m.track_width_m;
}

}  // namespace

const std::vector<GrammarHook>& all_grammar_hooks() {
  using C = Channel;
  using M = WheelModel;
  using S = MotionState;
  const auto one = [](C, const M&, const S&, double) { return 1.0; };
  static const std::vector<GrammarHook> kHooks{
      {"wheels0.scale",
       "1",
       0.01,
       kWheels,
       {C::kWheelDistance, C::kWheelHeading},
       [](C c, const M&, const S& s, double dt) { return wheel_scale(c, s, dt); }},
      {"wheels0.left_scale",
       "1",
       0.01,
       kWheels,
       {C::kWheelDistance, C::kWheelHeading},
       [](C c, const M& m, const S& s, double dt) { return one_wheel(c, m, s, dt, -1); }},
      {"wheels0.right_scale",
       "1",
       0.01,
       kWheels,
       {C::kWheelDistance, C::kWheelHeading},
       [](C c, const M& m, const S& s, double dt) { return one_wheel(c, m, s, dt, 1); }},
      {"wheels0.turn",
       "rad/s",
       0.01,
       kWheels,
       {C::kWheelHeading},
       [](C, const M&, const S&, double dt) { return dt; }},
      {"steering0.angle", "rad", 0.01, kSteeringBit, {C::kSteering}, one},
      {"imu0.yaw_rate", "rad/s", 0.005, kGyroBit, {C::kGyro}, one},
      {"poses.along", "m", 0.03, kPoses, {C::kPoseAlong}, one},
      {"poses.across", "m", 0.03, kPoses, {C::kPoseAcross}, one},
      {"poses.heading", "rad", 0.005, kPoses, {C::kPoseHeading}, one},
      {"steering0.scale", "1", 0.02, kSteeringBit, {C::kSteering}, nullptr, "steering0.ratio"},
      {"imu0.scale", "1", 0.01, kGyroBit, {C::kGyro}, nullptr, "imu0.gyro_scale"},
      {"wheels0.time",
       "s",
       0.02,
       kWheels | kSteeringBit,
       {C::kWheelDistance, C::kWheelHeading, C::kSteering},
       nullptr,
       "wheels0.latency"},
      {"steering0.time", "s", 0.02, kSteeringBit, {C::kSteering}, nullptr, "steering0.latency"},
      {"poses.scale", "1", 0.01, kPoses, {C::kPoseAlong, C::kPoseAcross}, nullptr, "map.scale"},
      {"imu0.time", "s", 0.02, kGyroBit, {C::kGyro}, nullptr, "imu0.latency"},
      {"poses.time",
       "s",
       0.02,
       kPoses,
       {C::kPoseAlong, C::kPoseAcross, C::kPoseHeading},
       nullptr,
       "cam.latency"},
  };
  return kHooks;
}

const GrammarHook* find_grammar_hook(std::string_view name) {
  const auto found = std::find_if(all_grammar_hooks().begin(), all_grammar_hooks().end(),
                                  [&](const GrammarHook& h) { return h.name == name; });
  return found == all_grammar_hooks().end() ? nullptr : &*found;
}

const GrammarHook& grammar_hook(std::string_view name) {
  const GrammarHook* hook = find_grammar_hook(name);
  ROADBOOK_ASSERT(hook != nullptr);
  return *hook;
}

// Of a hook, or of a named effect that is one.
std::vector<Channel> grammar_channels(std::string_view name) {
  if (const GrammarHook* hook = find_grammar_hook(name); hook != nullptr) return hook->channels;
  std::vector<Channel> all;
  for (std::size_t c = 0; c < kChannels; ++c) all.push_back(static_cast<Channel>(c));
  return all;
}

}  // namespace roadbook
