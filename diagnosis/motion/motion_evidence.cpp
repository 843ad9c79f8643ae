#include "diagnosis/motion/motion_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "diagnosis/motion/grammar.hpp"
#include "diagnosis/motion/grammar_hooks.hpp"
#include "diagnosis/streams/motion_effects.hpp"
#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/shown_unit.hpp"

namespace roadbook {
namespace {

// Root mean square of a channel's residuals with the extended model.
double spread_of(const Observations& obs, const MotionModel& model, std::size_t channel) {
  const auto first = obs.offsets();
  double squares = 0.0;
  for (std::size_t i = first[channel]; i < first[channel + 1]; ++i)
    squares += model.point.residual[i] * model.point.residual[i];
  return std::sqrt(squares /
                   std::max(1.0, static_cast<double>(first[channel + 1] - first[channel])));
}

// The channel whose readings the effect changes most, in units of their scatter.
Channel telling_motion_channel(const Observations& obs,
                               const MotionModel& extended,
                               const Columns& columns) {
  std::array<double, kChannels> weight{};
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double spread = spread_of(obs, extended, c);
    if (spread <= 0.0) continue;
    for (const Columns::Part& part : columns.of(static_cast<Channel>(c)))
      for (const double v : part.values) weight[c] += std::pow(v / spread, 2);
  }
  return static_cast<Channel>(std::max_element(weight.begin(), weight.end()) - weight.begin());
}

struct Covariate {
  std::string axis;
  double (*of)(const MotionState&, double t_s, double phase);  ///< `t_s` since the first pose
  const ColumnCovariate* column = nullptr;                     ///< of the log, instead
};

Covariate covariate_of(const Observations& obs, const Candidate& cause) {
  if (cause.kind == CandidateKind::kGrammar)
    for (const ColumnCovariate& column : obs.columns)
      if (column.name() == cause.covariate) return {column.axis(), nullptr, &column};
  const std::string name = cause.kind == CandidateKind::kGrammar
                               ? cause.covariate
                               : std::string(declaration_of(cause.name).covariate);
  using S = MotionState;
  if (name == "speed") return {"speed [m/s]", [](const S& s, double, double) { return s.speed; }};
  if (name == "turn rate" || name == "yaw rate" || name == "steering angle")
    return {"turn rate [rad/s]", [](const S& s, double, double) { return s.yaw_rate; }};
  if (name == "acceleration")
    return {"acceleration [m/s^2]", [](const S& s, double, double) { return s.acceleration; }};
  if (name == "lateral acceleration")
    return {"lateral acceleration [m/s^2]",
            [](const S& s, double, double) { return s.speed * s.yaw_rate; }};
  if (name.find("phase") != std::string::npos)
    return {"wheel phase [rad]", [](const S&, double, double phase) {
              return std::remainder(phase, 2.0 * std::numbers::pi);
            }};
  if (name == "heading")
    return {"heading [rad]", [](const S& s, double, double) {
              return std::remainder(s.heading, 2.0 * std::numbers::pi);
            }};
  if (name == "distance" || name == "wet ground")
    return {"distance driven [m]", [](const S& s, double, double) { return s.distance_m; }};
  return {"time [s]", [](const S&, double t, double) { return t; }};
}

double phase_at(const Observations& obs, double t_s) {
  const auto after =
      std::lower_bound(obs.wheels.begin(), obs.wheels.end(), t_s,
                       [](const WheelObservation& w, double t) { return w.t_s < t; });
  return after == obs.wheels.end() ? 0.0 : after->left_rad;
}

std::vector<double> times_of(const Observations& obs, const MotionModel& model, Channel channel) {
  const RowTimes times = row_times(obs, model.point.effects);
  std::vector<double> t(obs.rows(channel));
  for (std::size_t k = 0; k < t.size(); ++k) switch (channel) {
      case Channel::kWheelDistance:
      case Channel::kWheelHeading:
        t[k] = 0.5 * (times.wheels[k] + times.wheels[k + 1]);
        break;
      case Channel::kSteering:
        t[k] = 0.5 * (times.steering_begin[k] + times.steering_end[k]);
        break;
      case Channel::kGyro:
        t[k] = 0.5 * (times.gyro_begin[k] + times.gyro_end[k]);
        break;
      default:
        t[k] = times.poses[k];
    }
  return t;
}

// Of each row that has one.
std::vector<std::optional<double>> covariate_at(const Observations& obs,
                                                const Trajectory& trajectory,
                                                const std::vector<double>& times,
                                                const Covariate& covariate) {
  std::vector<std::optional<double>> values;
  for (const double t : times)
    values.push_back(
        covariate.column != nullptr
            ? covariate.column->at(t)
            : covariate.of(trajectory.rates_at(t), t - obs.origin_s, phase_at(obs, t)));
  return values;
}

// Covariate and residual over spread of every row of the channel.
std::vector<EvidenceValue> motion_values(const Observations& obs,
                                         const MotionModel& model,
                                         const Trajectory& trajectory,
                                         Channel channel,
                                         const Covariate& covariate,
                                         double spread) {
  std::vector<EvidenceValue> values;
  const auto at = covariate_at(obs, trajectory, times_of(obs, model, channel), covariate);
  const std::size_t first = obs.offsets()[index_of(channel)];
  for (std::size_t k = 0; k < at.size(); ++k)
    if (at[k]) values.emplace_back(*at[k], model.point.residual[first + k] / spread);
  return values;
}

// The smooth function of a term's covariate that was found, by the rows of its hook's first stream.
std::vector<std::pair<double, double>> term_curve(const Observations& obs,
                                                  const MotionModel& extended,
                                                  const Candidate& term,
                                                  const Covariate& covariate) {
  constexpr std::size_t kPoints = 25;
  std::vector<std::pair<double, double>> points;
  // A place has two coordinates.
  if (term.covariate == "constant" || term.covariate == "place") return points;
  const auto found = std::find_if(extended.accepted.begin(), extended.accepted.end(),
                                  [&](const Accepted& a) { return a.candidate.name == term.name; });
  const auto channels = grammar_channels(term.hook);
  const auto channel =
      std::find_if(channels.begin(), channels.end(), [&](Channel c) { return obs.rows(c) > 0; });
  if (found == extended.accepted.end() || channel == channels.end()) return points;
  const MotionPoint point{smoothed(extended.point.trajectory), extended.point.effects, {}};
  Grammar grammar(obs, point);
  const Grammar::Terms& terms = grammar.terms(term.covariate, *channel);
  const auto at = covariate_at(obs, point.trajectory, times_of(obs, extended, *channel), covariate);
  const Eigen::VectorXd& size = found->size;
  const auto mean = size.size() - static_cast<Eigen::Index>(terms.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (!at[k]) continue;
    double y = mean > 0 ? size[0] : 0.0;
    for (std::size_t i = 0; i < terms.size(); ++i)
      y += size[mean + static_cast<Eigen::Index>(i)] * terms[i][k];
    points.emplace_back(*at[k], y);
  }
  std::sort(points.begin(), points.end());
  std::vector<std::pair<double, double>> thinned;
  for (std::size_t i = 0; i < kPoints && !points.empty(); ++i) {
    const auto& p = points[i * (points.size() - 1) / (kPoints - 1)];
    if (thinned.empty() || p.first > thinned.back().first) thinned.push_back(p);
  }
  return thinned;
}

}  // namespace

EvidencePlot motion_evidence(const Observations& obs,
                             const MotionModel& nominal,
                             const MotionModel& extended,
                             const Candidate& cause) {
  const Columns column = candidate_columns(obs, nominal.point, {cause});
  const Channel channel = telling_motion_channel(obs, extended, column);
  const Covariate covariate = covariate_of(obs, cause);
  const Trajectory smooth = smoothed(extended.point.trajectory);
  const double spread = std::max(spread_of(obs, extended, index_of(channel)), 1e-300);
  std::vector<EvidenceValue> old = motion_values(obs, nominal, smooth, channel, covariate, spread);
  std::vector<EvidenceValue> now = motion_values(obs, extended, smooth, channel, covariate, spread);
  EvidencePlot plot;
  plot.channel = std::string(stream_of(channel)) + " " + std::string(name_of(channel));
  plot.covariate = covariate.axis;
  plot.bins = evidence_bins(std::move(old), std::move(now));
  const ShownUnit shown = shown_unit(obs, channel);
  plot.deviation = shown.factor * spread;
  plot.unit = shown.name;
  if (cause.kind == CandidateKind::kGrammar) {
    plot.curve = term_curve(obs, extended, cause, covariate);
    plot.curve_unit = cause.unit;
  }
  return plot;
}

}  // namespace roadbook
