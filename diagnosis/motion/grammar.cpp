#include "diagnosis/motion/grammar.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "diagnosis/motion/effect_columns.hpp"
#include "diagnosis/motion/grammar_hooks.hpp"
#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/wheel_rows.hpp"

namespace roadbook {
namespace {

using Moment = GrammarMoment;

// What one wheel that is read rolls: its scale moves its row by as much.
double one_wheel_read(const Observations& obs, const MotionState& s, double dt) {
  TrueMotion<double> motion;
  motion.distance_m = s.speed * dt;
  motion.turn_rad = s.yaw_rate * dt;
  return predict_wheel_row(obs.wheel_model, obs.wheels_read, {}, motion).x();
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
  if (covariate == "curvature") {
    constexpr double kSlow = 0.3;  // [m/s]: below, a quotient of noise
    const double curvature = std::abs(s.speed) > kSlow ? s.yaw_rate / s.speed : 0.0;
    return both(curvature, std::abs(curvature));
  }
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

Grammar::Terms motion_column_terms(const ColumnCovariate& column,
                                   const std::vector<Moment>& rows,
                                   double origin_s) {
  Grammar::Terms terms(column.terms(), std::vector<double>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto values = column.terms_at(rows[k].t_s + origin_s);
    for (std::size_t i = 0; i < terms.size(); ++i) terms[i][k] = values[i];
  }
  return terms;
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
  for (const GrammarHook& hook : all_grammar_hooks()) {
    const bool read = std::any_of(hook.channels.begin(), hook.channels.end(),
                                  [&](Channel c) { return obs.rows(c) > 0; });
    // One speed is one wheel: its scale is that of the wheels.
    const bool one_of_two = hook.name.ends_with("left_scale") || hook.name.ends_with("right_scale");
    // Residuals of a map's poses are errors of the map, which its observations judge. Without
    // wheels, only the smoothness of driving would constrain positions along the way.
    const bool judged = obs.poses_of_map && hook.name.starts_with("poses");
    const bool alone = obs.wheels.empty() && hook.name == "poses.along";
    if (read && !judged && !alone && !(one_of_two && obs.wheels_read != WheelsRead::kBoth))
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

bool is_grammar_covariate(std::string_view name) {
  const auto own = grammar_covariates("wheels0");
  return name == "curvature" || std::find(own.begin(), own.end(), name) != own.end();
}

double grammar_tau(std::string_view hook) { return grammar_hook(hook).tau; }
std::string_view grammar_unit(std::string_view hook) { return grammar_hook(hook).unit; }

std::string_view grammar_constant(std::string_view hook) {
  if (const GrammarHook& h = grammar_hook(hook); !h.like.empty()) return h.like;
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
  for (const ColumnCovariate& column : obs_.columns)
    if (column.name() == covariate) return terms = motion_column_terms(column, rows, obs_.origin_s);
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
  std::vector<Channel> channels = grammar_channels(term.hook);
  std::erase_if(channels, [&](Channel c) { return gains(term.hook, c).empty(); });
  Columns columns;
  if (channels.empty()) return columns;
  const std::size_t count = terms(term.covariate, channels.front()).size();
  for (std::size_t i = 0; i < count; ++i) {
    columns.add();
    for (const Channel channel : channels) {
      const Terms& f = terms(term.covariate, channel);
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
  if (obs_.rows(channel) == 0) return gains;
  const GrammarHook* hook = find_grammar_hook(name);
  if (hook == nullptr || hook->gain == nullptr) {
    const Columns like =
        effect_column(obs_, point_, effect_index(hook == nullptr ? name : hook->like));
    for (const Channel c : grammar_channels(name)) {
      gains_.try_emplace({name, c});
      for (const Columns::Part& part : like.of(c)) gains_[{name, c}] = part.values;
    }
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
      gains.push_back(hook->gain(channel, obs_.wheel_model, s, dt));
  }
  return gains;
}

}  // namespace roadbook
