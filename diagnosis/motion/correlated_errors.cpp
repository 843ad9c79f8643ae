#include "diagnosis/motion/correlated_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

// Moves the trajectory to the optimum for the model's noise, without effects. Steering is far from
// linear where the speed is wrong: it counts only after the first iterations.
void follow(const Observations& obs, MotionModel& model) {
  constexpr int kWithoutSteering = 4, kIterations = 8;
  constexpr double kLoose = 100.0;
  const Columns none;
  for (int i = 0; i < kIterations; ++i) {
    MotionNoise noise = model.noise;
    if (i < kWithoutSteering) noise.steering_rad *= kLoose;
    renew_residual(obs, model);
    const Pass pass = run_pass(obs, model.point, noise, none, {true, 0, &model.inflation});
    apply_solution(pass.elimination.back_substitute({1.0}), model.point.trajectory);
  }
}

// Parameters of the poses' noise, searched by their logarithms.
struct PoseParameter {
  double* value = nullptr;
  double* follows = nullptr;  ///< changes by the same factor
  double least = 0.0;
  double most = 0.0;
};

std::vector<PoseParameter> parameters_of(MotionNoise& noise, bool with_heading) {
  constexpr double kLeastS = 0.05, kMostS = 60.0, kMostM = 20.0, kMostRad = 0.5;
  LastingErrors& of = noise.lasting;
  std::vector<PoseParameter> all{
      {&of.position_m, nullptr, 1e-4, kMostM},
      {&of.position_s, nullptr, kLeastS, kMostS},
      {&noise.pose[0], &noise.pose[1], MotionNoise::kLeastPosition, kMostM}};
  if (!with_heading) return all;
  all.push_back({&of.heading_rad, nullptr, 1e-5, kMostRad});
  all.push_back({&of.heading_s, nullptr, kLeastS, kMostS});
  all.push_back({&noise.pose[2], nullptr, MotionNoise::kLeastHeading, kMostRad});
  return all;
}

// Multiplies a parameter by e^step within its bounds; false if nothing changes.
bool stretch(const PoseParameter& p, double step) {
  const double next = std::clamp(*p.value * std::exp(step), p.least, p.most);
  const double factor = next / *p.value;
  if (std::abs(factor - 1.0) < 1e-9) return false;
  *p.value = next;
  if (p.follows != nullptr) *p.follows = std::max(*p.follows * factor, p.least);
  return true;
}

// Starts of the search: the errors that last have the present scatter, for these times [s].
MotionNoise start_of_lasting(const MotionNoise& noise, double time_s, bool with_heading) {
  constexpr double kWhiteShare = 0.4;
  MotionNoise next = noise;
  next.lasting.position_m = std::max(0.5 * (noise.pose[0] + noise.pose[1]), 1e-3);
  next.lasting.position_s = next.lasting.heading_s = time_s;
  next.lasting.heading_rad = with_heading ? std::max(noise.pose[2], 1e-4) : 0.0;
  for (std::size_t i = 0; i < 2; ++i)
    next.pose[i] = std::max(kWhiteShare * noise.pose[i], MotionNoise::kLeastPosition);
  next.pose[2] = std::max(kWhiteShare * noise.pose[2], MotionNoise::kLeastHeading);
  return next;
}

// Climbs the likelihood by steps of one parameter, then of all together (Hooke and Jeeves 1961).
class PoseNoiseSearch {
 public:
  PoseNoiseSearch(const Observations& obs, const MotionModel& model, const HeldEffects& s)
      : obs_(obs), s_(s), trial_(model), best_(model.noise) {
    likelihood_ = of(best_);
  }
  [[nodiscard]] const MotionNoise& best() const { return best_; }

  void try_starts() {
    constexpr std::array kTimesS{0.2, 1.0, 5.0};
    constexpr std::array kWhite{1.0, 0.2};
    const MotionNoise start = best_;
    for (const double white : kWhite)
      for (const double time_s : kTimesS) {
        MotionNoise next = start;
        next.lasting.position_s = next.lasting.heading_s = time_s;
        for (double& sigma : next.pose) sigma *= white;
        next.pose[0] = std::max(next.pose[0], MotionNoise::kLeastPosition);
        next.pose[1] = std::max(next.pose[1], MotionNoise::kLeastPosition);
        next.pose[2] = std::max(next.pose[2], MotionNoise::kLeastHeading);
        consider(next);
      }
  }

  void climb(double step) {
    constexpr double kLeastStep = 0.12;
    constexpr int kMostSweeps = 8;
    for (int sweep = 0; sweep < kMostSweeps && step > kLeastStep; ++sweep) {
      const MotionNoise before = best_;
      if (!climb_each(step))
        step *= 0.5;
      else
        step_on(before);
    }
  }

 private:
  [[nodiscard]] double of(const MotionNoise& noise) {
    trial_.noise = noise;
    return log_likelihood(obs_, trial_, s_);
  }
  bool consider(const MotionNoise& noise) {
    const double l = of(noise);
    if (l <= likelihood_) return false;
    likelihood_ = l;
    best_ = noise;
    return true;
  }
  bool climb_each(double step) {
    bool climbed = false;
    for (std::size_t p = 0; p < parameters_of(best_, obs_.poses_have_heading).size(); ++p)
      for (const double way : {step, -step}) {
        MotionNoise next = best_;
        if (!stretch(parameters_of(next, obs_.poses_have_heading)[p], way) || !consider(next))
          continue;
        climbed = true;
        break;
      }
    return climbed;
  }
  // The same change of all parameters once more.
  void step_on(MotionNoise before) {
    MotionNoise next = best_;
    auto to = parameters_of(next, obs_.poses_have_heading);
    const auto from = parameters_of(before, obs_.poses_have_heading);
    for (std::size_t p = 0; p < to.size(); ++p)
      stretch(to[p], std::log(*to[p].value / *from[p].value));
    consider(next);
  }

  const Observations& obs_;
  const HeldEffects& s_;
  MotionModel trial_;
  MotionNoise best_;
  double likelihood_ = 0.0;
};

}  // namespace

void begin_lasting_errors(const Observations& obs, MotionModel& model) {
  constexpr double kTimeS = 1.0;
  model.noise = start_of_lasting(model.noise, kTimeS, obs.poses_have_heading);
  follow(obs, model);
}

void fit_lasting_errors(const Observations& obs,
                        MotionModel& model,
                        const HeldEffects& s,
                        bool first) {
  model.noise.creep_per_sqrt_m =
      std::min(model.noise.creep_per_sqrt_m, MotionNoise{}.creep_per_sqrt_m);
  renew_residual(obs, model);
  PoseNoiseSearch search(obs, model, s);
  if (first) search.try_starts();
  search.climb(first ? 0.6 : 0.2);
  model.noise = search.best();
}

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
