#include "diagnosis/motion/large_effects.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/inference/search.hpp"
#include "diagnosis/motion/closed_form_start.hpp"
#include "diagnosis/motion/motion_problem.hpp"
#include "diagnosis/streams/lag_by_correlation.hpp"
#include "diagnosis/streams/motion_prediction.hpp"

namespace roadbook {
namespace {

// Scatter of innovations [sigma] above which large effects are searched; effects of plausible size
// stay below.
constexpr double kGross = 15.0;
// The other streams count as this many times better than they fit: enough to be heard.
constexpr double kTemper = 3.0;
constexpr int kGrossRounds = 4;

double root_mean_square(const std::vector<double>& values, std::size_t from, std::size_t to) {
  double squares = 0.0;
  for (std::size_t i = from; i < to; ++i) squares += values[i] * values[i];
  return std::sqrt(squares / std::max(1.0, static_cast<double>(to - from)));
}

MotionNoise tempered_noise(const Observations& obs, const MotionPoint& point) {
  MotionNoise noise = stated_noise(obs);
  const auto first = obs.offsets();
  const auto spread = [&](Channel c) {
    return root_mean_square(point.residual, first[index_of(c)], first[index_of(c) + 1]) / kTemper;
  };
  noise.steering_rad = std::max(noise.steering_rad, spread(Channel::kSteering));
  noise.gyro_rad_s = std::max(noise.gyro_rad_s, spread(Channel::kGyro));
  // Of the wheels' walks: residuals are of steps of some length.
  double length = 0.0;
  const RowTimes times = row_times(obs, point.effects);
  for (std::size_t k = 0; k + 1 < times.wheels.size(); ++k)
    length += std::abs(point.trajectory.rates_at(times.wheels[k + 1]).distance_m -
                       point.trajectory.rates_at(times.wheels[k]).distance_m);
  const auto steps = static_cast<double>(obs.rows(Channel::kWheelDistance));
  const double root = std::sqrt(std::max(length / std::max(steps, 1.0), 1e-6));
  noise.distance_per_sqrt_m =
      std::max(noise.distance_per_sqrt_m, spread(Channel::kWheelDistance) / root);
  noise.heading_per_sqrt_m =
      std::max(noise.heading_per_sqrt_m, spread(Channel::kWheelHeading) / root);
  return noise;
}

// A model about the poses' own trajectory that believes the other streams no more than they fit.
MotionModel tempered_model(const Observations& obs, const EffectSizes& known) {
  MotionModel model;
  model.known = motion_effects_of(known);
  model.point.effects = model.known;
  model.point.trajectory = trajectory_of_poses(obs, model.known.pose.latency);
  model.inflation.assign(obs.offsets().back(), 1.0);
  renew_residual(obs, model);
  model.noise = loosened(tempered_noise(obs, model.point));
  fit_model(obs, model, 2);
  return model;
}

}  // namespace

bool has_large_effects(const Observations& obs,
                       const MotionModel& nominal,
                       const EffectSizes& known,
                       const LibraryOptions& library) {
  if (!start_of_large_effects(obs, known, library).empty()) return true;
  const Innovations in =
      run_pass(obs, nominal.point, nominal.noise, Columns{}, {false, 0, &nominal.inflation})
          .innovations;
  std::array<double, kChannels> squares{}, rows{};
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    const double e = in.row(i)[0];
    squares[in.of[i].channel] += e * e;
    rows[in.of[i].channel] += 1.0;
  }
  for (std::size_t c = 0; c < kChannels; ++c)
    if (rows[c] > 0.0 && std::sqrt(squares[c] / rows[c]) > kGross) return true;
  return false;
}

EffectSizes large_effects_of(const Observations& obs,
                             const EffectSizes& known,
                             const LibraryOptions& library) {
  LibraryOptions names = library;
  names.places = names.grammar = names.bounds = false;
  SearchOptions options;
  options.doubt_correlated = false;
  EffectSizes large = start_of_large_effects(obs, known, library);
  for (int round = 0; round < kGrossRounds; ++round) {
    EffectSizes all = known;
    for (const auto& [name, size] : large) all[name] += size;
    const Observations covered = covered_by_poses(obs, all);
    const MotionProblem problem(covered, tempered_model(covered, all), names);
    const SearchResult found = search_causes(problem, options);
    bool moved = false;
    for (const AcceptedEffect& v : found.verdicts) {
      large[v.cause.candidate.name] += v.cause.size[0];
      moved = moved || std::abs(v.cause.size[0]) > 0.2 * v.cause.candidate.tau;
    }
    if (!moved) break;
  }
  return large;
}

}  // namespace roadbook
