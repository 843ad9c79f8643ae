#include "diagnosis/evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "diagnosis/motion_effects.hpp"
#include "diagnosis/motion_prediction.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kBins = 24;

// The channel in which the cause's column weighs most once the trajectory is projected out.
Channel telling_channel(const Innovations& in) {
  std::array<double, kChannels> weight{};
  for (std::size_t i = 0; i < in.of.size(); ++i)
    for (std::size_t k = 1; k < in.sides; ++k)
      weight[index_of(in.of[i].channel)] += in.row(i)[k] * in.row(i)[k];
  return static_cast<Channel>(std::max_element(weight.begin(), weight.end()) - weight.begin());
}

struct Covariate {
  std::string axis;
  double (*of)(const MotionState&, double t_s, double phase);
};

Covariate covariate_of(const Candidate& cause) {
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

Innovations innovations_of(const Observations& obs,
                           const MotionModel& model,
                           const Columns& columns) {
  return run_pass(obs, model.point, model.noise, columns, {false, 0, &model.inflation}).innovations;
}

// Covariate and innovation of every row of the channel, by row.
std::vector<std::pair<double, double>> values_of(const Observations& obs,
                                                 const Innovations& in,
                                                 const Trajectory& trajectory,
                                                 Channel channel,
                                                 const Covariate& covariate) {
  std::vector<std::pair<double, double>> values;
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    if (in.of[i].channel != channel) continue;
    const double t = in.of[i].t_s;
    values.emplace_back(covariate.of(trajectory.at(t), t - obs.origin_s, phase_at(obs, t)),
                        in.row(i)[0]);
  }
  return values;
}

}  // namespace

EvidencePlot evidence_of(const Observations& obs,
                         const MotionModel& nominal,
                         const MotionModel& extended,
                         const Candidate& cause) {
  const Columns column = candidate_columns(obs, nominal.point, {cause});
  const Innovations before = innovations_of(obs, nominal, column);
  Columns none;
  none.values.resize(1);
  const Innovations after = innovations_of(obs, extended, none);
  const Channel channel = telling_channel(before);
  const Covariate covariate = covariate_of(cause);
  const Trajectory smooth = smoothed(extended.point.trajectory);
  auto old = values_of(obs, before, smooth, channel, covariate);
  auto now = values_of(obs, after, smooth, channel, covariate);
  EvidencePlot plot;
  plot.channel = std::string(stream_of(channel)) + " " + std::string(name_of(channel));
  plot.covariate = covariate.axis;
  if (old.empty() || now.empty()) return plot;
  std::sort(old.begin(), old.end());
  std::sort(now.begin(), now.end());
  // Bins of equally many rows: each mean is as certain as the others.
  for (std::size_t b = 0; b < kBins; ++b) {
    EvidenceBin bin;
    const auto mean = [b](const auto& values, double& x) {
      const std::size_t from = b * values.size() / kBins;
      const std::size_t to = (b + 1) * values.size() / kBins;
      double sum = 0.0;
      x = 0.0;
      for (std::size_t i = from; i < to; ++i) {
        x += values[i].first / static_cast<double>(to - from);
        sum += values[i].second / static_cast<double>(to - from);
      }
      return sum;
    };
    double unused = 0.0;
    bin.before = mean(old, unused);
    bin.after = mean(now, bin.x);
    bin.rows = now.size() / kBins;
    if (bin.rows == 0) return plot;
    bin.sigma = 1.0 / std::sqrt(static_cast<double>(bin.rows));
    plot.bins.push_back(bin);
  }
  return plot;
}

}  // namespace roadbook
