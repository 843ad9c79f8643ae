#include "diagnosis/motion/correlated_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "diagnosis/streams/coarse_readings.hpp"
#include "diagnosis/streams/window_noise.hpp"

namespace roadbook {
namespace {

constexpr std::array kPoseChannels{Channel::kPoseAlong, Channel::kPoseAcross,
                                   Channel::kPoseHeading};

// Sum of all autocorrelations, 1 for white values: the factor by which the variance of a slow mean
// exceeds that of independent values. The sum ends where autocorrelations vanish in their own
// scatter; it is 1 if the first lag does.
double correlated_share(const std::vector<double>& e) {
  const auto n = static_cast<double>(e.size());
  if (n < 100.0) return 1.0;
  double squares = 0.0;
  for (const double v : e) squares += v * v;
  if (!(squares > 0.0)) return 1.0;
  double sum = 1.0;
  constexpr std::size_t kMostLags = 500;  // keeps it linear
  for (std::size_t lag = 1; 4 * lag < e.size() && lag < kMostLags; ++lag) {
    double r = 0.0;
    for (std::size_t i = lag; i < e.size(); ++i) r += e[i] * e[i - lag] / squares;
    if (r < (lag == 1 ? 5.0 : 2.0) / std::sqrt(n)) break;
    sum += 2.0 * r;
  }
  return sum;
}

struct Leftovers {
  std::array<std::vector<double>, kChannels> values;  ///< innovations
  std::vector<double> weights;
  Pass pass;

  /// Error of a slow mean over what the noise allows for; 0 without autocorrelation of the
  /// innovations.
  [[nodiscard]] double slow_error(Channel channel) const {
    const std::vector<double>& e = values[index_of(channel)];
    const double share = correlated_share(e);
    if (share <= 1.0) return 0.0;
    double square = 0.0;
    for (const double v : e) square += v * v / static_cast<double>(e.size());
    return std::sqrt(square * share);
  }
};

Leftovers leftovers(const Observations& obs, MotionModel& model, const HeldEffects& s) {
  renew_residual(obs, model);
  Leftovers left{
      {},
      {},
      run_pass(obs, model.point, model.noise, s.library.columns, {true, 0, &model.inflation})};
  const Innovations& in = left.pass.innovations;
  left.weights = saturated_weights(normal_equations(in, s.library.columns.count()), s, in);
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    double e = 0.0;
    for (std::size_t k = 0; k < in.sides; ++k) e += left.weights[k] * in.row(i)[k];
    left.values[in.of[i].channel].push_back(e);
  }
  return left;
}

// The trajectory follows autocorrelated errors as far as their noise allows. A few rounds are
// needed to find all of them.
void allow_for_correlated(std::span<const Channel> channels,
                          const Observations& obs,
                          MotionModel& model,
                          const HeldEffects& s) {
  constexpr int kRounds = 4;
  constexpr double kNoMore = 1.05;
  for (int round = 0; round < kRounds; ++round) {
    const Leftovers left = leftovers(obs, model, s);
    bool grown = false;
    for (const Channel channel : channels) {
      const double factor = left.slow_error(channel);
      if (factor <= kNoMore) continue;
      model.noise.sigma(channel) *= factor;
      grown = true;
    }
    if (!grown) return;
    apply_solution(left.pass.elimination.back_substitute(left.weights), model.point.trajectory);
  }
}

}  // namespace

bool poses_correlate(const Observations& obs, MotionModel& model, const HeldEffects& s) {
  const Leftovers left = leftovers(obs, model, s);
  return std::any_of(kPoseChannels.begin(), kPoseChannels.end(),
                     [&](Channel c) { return left.slow_error(c) > 0.0; });
}

void allow_for_correlated_poses(const Observations& obs, MotionModel& model, const HeldEffects& s) {
  // Autocorrelated sideways errors of poses were estimated as creep; this step separates the two.
  model.noise.creep_per_sqrt_m =
      std::min(model.noise.creep_per_sqrt_m, MotionNoise{}.creep_per_sqrt_m);
  allow_for_correlated(kPoseChannels, obs, model, s);
}

void allow_for_correlated_steering(const Observations& obs,
                                   MotionModel& model,
                                   const std::vector<Accepted>& places) {
  const auto& windows = windows_of_noise(obs, Channel::kSteering);
  if (neighbours_correlate(windows, smoothed(model.point.trajectory)))
    allow_for_correlated(std::array{Channel::kSteering}, obs, model,
                         saturated_library(obs, model.point, places, true));
}

}  // namespace roadbook
