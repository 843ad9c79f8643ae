#include "diagnosis/grammar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "diagnosis/columns.hpp"
#include "diagnosis/motion_prediction.hpp"

namespace roadbook {
namespace {

// One row as a covariate sees it.
struct Moment {
  MotionState state;
  double t_s = 0.0;
  double left_phase = 0.0;
  double right_phase = 0.0;
};

// Where a term of size 1 moves the rows of one or two channels.
struct Hook {
  std::string_view name;
  std::string_view unit;
  double tau;
  unsigned streams;
  std::vector<Channel> channels;
  /// Change of a row of the channel by a term f = 1; `dt`: time between wheel readings.
  std::function<double(Channel, const WheelModel&, const MotionState&, double dt)> gain;
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
      {"wheels0.time",
       "s",
       0.02,
       kWheels | kSteeringBit,
       {C::kWheelDistance, C::kWheelHeading, C::kSteering},
       {},
       "wheels0.latency"},
      {"imu0.time", "s", 0.02, kGyroBit, {C::kGyro}, {}, "imu0.latency"},
      {"poses.time",
       "s",
       0.02,
       kPoses,
       {C::kPoseAlong, C::kPoseAcross, C::kPoseHeading},
       {},
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

// Smooth functions of the covariate at one row; scaled and centred later.
std::vector<double> terms_of(std::string_view covariate, const Moment& m) {
  const MotionState& s = m.state;
  if (covariate == "constant") return {1.0};
  if (covariate == "speed") return {s.speed, s.speed * s.speed};
  if (covariate == "yaw rate") return {s.yaw_rate, std::abs(s.yaw_rate)};
  if (covariate == "acceleration") return {s.acceleration, std::abs(s.acceleration)};
  if (covariate == "lateral acceleration") {
    const double a = s.speed * s.yaw_rate;
    return {a, std::abs(a)};
  }
  if (covariate == "time") return {m.t_s, m.t_s * m.t_s, m.t_s * m.t_s * m.t_s};
  if (covariate == "heading") return {std::cos(s.heading), std::sin(s.heading)};
  if (covariate == "place") return {s.x, s.y, s.x * s.x, s.x * s.y, s.y * s.y};
  if (covariate == "left wheel phase") return {std::cos(m.left_phase), std::sin(m.left_phase)};
  if (covariate == "right wheel phase") return {std::cos(m.right_phase), std::sin(m.right_phase)};
  ROADBOOK_ASSERT(!"a covariate of the grammar");
  return {};
}

// Rows of a channel with their moments.
std::vector<Moment> moments(const Observations& obs, const MotionPoint& point, Channel channel) {
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

// Each function on its own: centred (but the constant), unit variance; a constant one becomes 0.
void scale(std::vector<std::vector<double>>& values, bool constant) {
  if (values.empty() || constant) return;
  const auto n = static_cast<double>(values.size());
  for (std::size_t k = 0; k < values.front().size(); ++k) {
    double mean = 0.0;
    double square = 0.0;
    for (const auto& v : values) mean += v[k] / n;
    for (const auto& v : values) square += (v[k] - mean) * (v[k] - mean) / n;
    const double over = square > 1e-12 * (1.0 + mean * mean) ? 1.0 / std::sqrt(square) : 0.0;
    for (auto& v : values) v[k] = (v[k] - mean) * over;
  }
}

}  // namespace

std::vector<std::string> grammar_hooks(const Observations& obs) {
  std::vector<std::string> names;
  for (const Hook& hook : hooks())
    if (has_streams(obs, hook.streams)) names.emplace_back(hook.name);
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

Columns grammar_columns(const Observations& obs,
                        const MotionPoint& smooth_point,
                        const GrammarTerm& term) {
  const Hook& hook = hook_of(term.hook);
  const auto first = obs.offsets();
  const Columns like =
      hook.like.empty() ? Columns{} : effect_columns(obs, smooth_point, {effect_index(hook.like)});
  Columns columns;
  for (const Channel channel : hook.channels) {
    const auto rows = moments(obs, smooth_point, channel);
    std::vector<std::vector<double>> values;
    for (const Moment& m : rows) values.push_back(terms_of(term.covariate, m));
    scale(values, term.covariate == "constant");
    if (values.empty()) continue;
    if (columns.count == 0) {
      columns.count = values.front().size();
      columns.values.assign(first.back() * columns.count, 0.0);
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const bool wheel = channel == Channel::kWheelDistance || channel == Channel::kWheelHeading;
      const double dt = wheel ? obs.wheels[k + 1].t_s - obs.wheels[k].t_s : 0.0;
      const std::size_t row = first[index_of(channel)] + k;
      const double gain =
          hook.gain ? hook.gain(channel, obs.wheel_model, rows[k].state, dt) : like.values[row];
      double* to = columns.values.data() + row * columns.count;
      for (std::size_t i = 0; i < columns.count; ++i) to[i] = gain * values[k][i];
    }
  }
  return columns;
}

}  // namespace roadbook
