#include "diagnosis/grammar.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "diagnosis/effect_columns.hpp"
#include "diagnosis/motion_prediction.hpp"
#include "diagnosis/wheel_rows.hpp"

namespace roadbook {
namespace {

using Moment = GrammarMoment;

// Where a term of size 1 moves the rows of one or two channels.
struct Hook {
  std::string_view name;
  std::string_view unit;
  double tau;
  unsigned streams;
  std::vector<Channel> channels;
  /// Change of a row of the channel by a term f = 1; `dt`: time between wheel readings.
  double (*gain)(Channel, const WheelModel&, const MotionState&, double dt);
  std::string_view like = {};  ///< moves the rows as this effect does, where there is no `gain`
};

double wheel_scale(Channel channel, const MotionState& s, double dt) {
  return channel == Channel::kWheelDistance ? s.speed * dt : s.yaw_rate * dt;
}
// One wheel turning more by a share: side -1 left, +1 right.
double one_wheel(Channel channel, const WheelModel& m, const MotionState& s, double dt, int side) {
  const double rolled = (s.speed + side * 0.5 * m.track_width_m * s.yaw_rate) * dt;
  return channel == Channel::kWheelDistance ? 0.5 * rolled : side * rolled / m.track_width_m;
}

// What one wheel that is read rolls: its scale moves its row by as much.
double one_wheel_read(const Observations& obs, const MotionState& s, double dt) {
  TrueMotion<double> motion;
  motion.distance_m = s.speed * dt;
  motion.turn_rad = s.yaw_rate * dt;
  return predict_wheel_row(obs.wheel_model, obs.wheels_read, {}, motion).x();
}

const std::vector<Hook>& hooks() {
  using C = Channel;
  using M = WheelModel;
  using S = MotionState;
  const auto one = [](C, const M&, const S&, double) { return 1.0; };
  static const std::vector<Hook> kHooks{
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

const Hook& hook_of(std::string_view name) {
  const auto found =
      std::find_if(hooks().begin(), hooks().end(), [&](const Hook& h) { return h.name == name; });
  ROADBOOK_ASSERT(found != hooks().end());
  return *found;
}

struct TermValues {
  std::size_t count = 0;
  std::array<double, 5> of{};
};

// Smooth functions of the covariate at one row; scaled and centred later.
TermValues terms_of(std::string_view covariate, const Moment& m) {
  const MotionState& s = m.state;
  const auto both = [](double x, double y) { return TermValues{2, {x, y}}; };
  if (covariate == "constant") return {1, {1.0}};
  if (covariate == "speed") return both(s.speed, s.speed * s.speed);
  if (covariate == "yaw rate") return both(s.yaw_rate, std::abs(s.yaw_rate));
  if (covariate == "acceleration") return both(s.acceleration, std::abs(s.acceleration));
  const double lateral = s.speed * s.yaw_rate;
  if (covariate == "lateral acceleration") return both(lateral, std::abs(lateral));
  if (covariate == "time") return {3, {m.t_s, m.t_s * m.t_s, m.t_s * m.t_s * m.t_s}};
  if (covariate == "heading") return both(std::cos(s.heading), std::sin(s.heading));
  if (covariate == "place") return {5, {s.x, s.y, s.x * s.x, s.x * s.y, s.y * s.y}};
  if (covariate == "left wheel phase") return both(std::cos(m.left_phase), std::sin(m.left_phase));
  ROADBOOK_ASSERT(covariate == "right wheel phase");
  return both(std::cos(m.right_phase), std::sin(m.right_phase));
}

// Rows of a channel with their moments.
std::vector<Moment> moments_of(const Observations& obs, const MotionPoint& point, Channel channel) {
  const RowTimes times = row_times(obs, point.effects);
  const Trajectory& trajectory = point.trajectory;
  std::vector<Moment> all(obs.rows(channel));
  for (std::size_t k = 0; k < all.size(); ++k) {
    double t = 0.0;
    switch (channel) {
      case Channel::kWheelDistance:
      case Channel::kWheelHeading:
        t = 0.5 * (times.wheels[k] + times.wheels[k + 1]);
        all[k].left_phase = 0.5 * (obs.wheels[k].left_rad + obs.wheels[k + 1].left_rad);
        all[k].right_phase = 0.5 * (obs.wheels[k].right_rad + obs.wheels[k + 1].right_rad);
        break;
      case Channel::kSteering:
        t = 0.5 * (times.steering_begin[k] + times.steering_end[k]);
        break;
      case Channel::kGyro:
        t = 0.5 * (times.gyro_begin[k] + times.gyro_end[k]);
        break;
      default:
        t = times.poses[k];
    }
    all[k].t_s = t - obs.origin_s;
    all[k].state = trajectory.at(t);
  }
  return all;
}

// Centred, unit variance; one that varies by less than `least` of its mean becomes 0.
void scale(std::vector<double>& values, double least) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  double square = 0.0;
  for (const double v : values) mean += v / n;
  for (const double v : values) square += (v - mean) * (v - mean) / n;
  const double threshold = 1e-12 + least * least * mean * mean;
  const double over = square > threshold ? 1.0 / std::sqrt(square) : 0.0;
  for (double& v : values) v = (v - mean) * over;
}

// Channels of one stream are read at the same moments.
Channel first_of_stream(Channel channel) {
  switch (channel) {
    case Channel::kWheelHeading:
      return Channel::kWheelDistance;
    case Channel::kPoseAcross:
    case Channel::kPoseHeading:
      return Channel::kPoseAlong;
    default:
      return channel;
  }
}

}  // namespace

std::vector<std::string> grammar_hooks(const Observations& obs) {
  std::vector<std::string> names;
  for (const Hook& hook : hooks()) {
    const bool read = std::any_of(hook.channels.begin(), hook.channels.end(),
                                  [&](Channel c) { return obs.rows(c) > 0; });
    // One speed is one wheel: its scale is that of the wheels.
    const bool one_of_two = hook.name.ends_with("left_scale") || hook.name.ends_with("right_scale");
    if (read && !(one_of_two && obs.wheels_read != WheelsRead::kBoth))
      names.emplace_back(hook.name);
  }
  return names;
}

std::vector<std::string> grammar_covariates(std::string_view hook) {
  std::vector<std::string> names{
      "constant", "speed",   "yaw rate", "acceleration", "lateral acceleration",
      "time",     "heading", "place"};
  if (hook.starts_with("wheels0")) {
    names.emplace_back("left wheel phase");
    names.emplace_back("right wheel phase");
  }
  return names;
}

double grammar_tau(std::string_view hook) { return hook_of(hook).tau; }
std::string_view grammar_unit(std::string_view hook) { return hook_of(hook).unit; }

std::string_view grammar_constant(std::string_view hook) {
  if (const Hook& h = hook_of(hook); !h.like.empty()) return h.like;
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kConstants{{
      {"wheels0.scale", "wheels0.radius"},
      {"wheels0.left_scale", "wheels0.left_radius"},
      {"wheels0.right_scale", "wheels0.right_radius"},
      {"steering0.angle", "steering0.offset"},
      {"imu0.yaw_rate", "imu0.gyro_bias"},
      {"poses.along", "cam.position"},
      {"poses.heading", "cam.rotation"},
  }};
  for (const auto& [name, effect] : kConstants)
    if (name == hook) return effect;
  return {};
}

Grammar::Grammar(const Observations& obs, const MotionPoint& smooth_point)
    : obs_(obs), point_(smooth_point) {}

const std::vector<GrammarMoment>& Grammar::moments(Channel channel) {
  const Channel first = first_of_stream(channel);
  auto& rows = moments_[index_of(first)];
  if (rows.empty()) rows = moments_of(obs_, point_, first);
  return rows;
}

const Grammar::Terms& Grammar::terms(const std::string& covariate, Channel channel) {
  const Channel first = first_of_stream(channel);
  const auto [at, fresh] = terms_.try_emplace({covariate, first});
  Terms& terms = at->second;
  if (!fresh) return terms;
  const auto& rows = moments(first);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const TermValues values = terms_of(covariate, rows[k]);
    if (terms.empty()) terms.assign(values.count, std::vector<double>(rows.size()));
    for (std::size_t i = 0; i < values.count; ++i) terms[i][k] = values.of[i];
  }
  if (covariate != "constant")
    for (std::vector<double>& f : terms) scale(f, covariate == "speed" ? kLeastSpeedChange : 1e-6);
  return terms;
}

Columns Grammar::columns(const GrammarTerm& term) {
  const Hook& hook = hook_of(term.hook);
  Columns columns;
  const std::size_t count = terms(term.covariate, hook.channels.front()).size();
  for (std::size_t i = 0; i < count; ++i) {
    columns.add();
    for (const Channel channel : hook.channels) {
      const Terms& f = terms(term.covariate, channel);
      if (f.empty() || obs_.rows(channel) == 0) continue;
      std::vector<double> values = gains(term.hook, channel);
      for (std::size_t k = 0; k < values.size(); ++k) values[k] *= f[i][k];
      columns.set(channel, std::move(values));
    }
  }
  return columns;
}

const std::vector<double>& Grammar::gains(const std::string& name, Channel channel) {
  const auto [at, fresh] = gains_.try_emplace({name, channel});
  std::vector<double>& gains = at->second;
  if (!fresh) return gains;
  const Hook& hook = hook_of(name);
  if (hook.gain == nullptr) {
    const Columns like = effect_column(obs_, point_, effect_index(hook.like));
    for (const Channel c : hook.channels)
      for (const Columns::Part& part : like.of(c)) gains_[{name, c}] = part.values;
    return gains;
  }
  const auto& rows = moments(channel);
  const bool wheel = channel == Channel::kWheelDistance || channel == Channel::kWheelHeading;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double dt = wheel ? obs_.wheels[k + 1].t_s - obs_.wheels[k].t_s : 0.0;
    const MotionState& s = rows[k].state;
    if (wheel && obs_.wheels_read != WheelsRead::kBoth)
      gains.push_back(one_wheel_read(obs_, s, dt));
    else
      gains.push_back(hook.gain(channel, obs_.wheel_model, s, dt));
  }
  return gains;
}

}  // namespace roadbook
