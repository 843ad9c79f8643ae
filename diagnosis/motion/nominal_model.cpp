#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "diagnosis/motion/correlated_errors.hpp"
#include "diagnosis/motion/motion_model.hpp"
#include "diagnosis/motion/regularised_effects.hpp"
#include "diagnosis/motion/wet_place_search.hpp"
#include "diagnosis/streams/coarse_readings.hpp"
#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/normal_equations.hpp"
#include "diagnosis/streams/window_noise.hpp"
#include "sensors/stream_noise.hpp"

namespace roadbook {
namespace {

constexpr int kNoiseIterations = 4;
constexpr std::size_t kPassProbes = 4;

// A mean that is off by its noise's scatter is inflated, not trusted: beyond five sigma lies one
// row in a million.
void inflate_outliers(const Innovations& in,
                      const std::vector<double>& weights,
                      std::vector<double>& inflation) {
  constexpr double kWide = 5.0;
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    const auto channel = static_cast<Channel>(in.of[i].channel);
    if (channel == Channel::kWheelDistance || channel == Channel::kWheelHeading) continue;
    double e = 0.0;
    for (std::size_t k = 0; k < in.sides; ++k) e += weights[k] * in.row(i)[k];
    double& inflated = inflation[in.of[i].row];
    if (std::abs(e) > kWide) inflated *= std::abs(e) / 2.0;
  }
}

// The model's noise, and of steering and gyro how their scatter changes with speed and turn where
// that is sure: no trajectory enters it.
EffectSizes weights_of(const Observations& obs, const Trajectory& smooth, EffectSizes known) {
  for (const Channel channel : {Channel::kSteering, Channel::kGyro}) {
    const std::string stream(stream_of(channel));
    const VarianceSlopes slopes = window_slopes(stream, windows_of_noise(obs, channel), smooth,
                                                noise_imperfections(known, stream));
    known[stream + ".variance(speed)"] = slopes.speed;
    known[stream + ".variance(turn)"] = slopes.turn;
  }
  return known;
}

// Middle of row k [s]; for wheels, of the roll from one reading to the next.
double time_of_row(const RowTimes& times, Channel channel, std::size_t k) {
  switch (channel) {
    case Channel::kWheelDistance:
    case Channel::kWheelHeading:
      return 0.5 * (times.wheels[k] + times.wheels[k + 1]);
    case Channel::kSteering:
      return 0.5 * (times.steering_begin[k] + times.steering_end[k]);
    case Channel::kGyro:
      return 0.5 * (times.gyro_begin[k] + times.gyro_end[k]);
    default:
      return times.poses[k];
  }
}

// Known growth of a channel's noise with speed and turn, over its mean square; for wheels, of the
// scatter along their way.
// wheels, noise of their way.
std::vector<double> known_inflation(const Observations& obs,
                                    const Trajectory& trajectory,
                                    const EffectSizes& known) {
  std::vector<double> inflation(obs.offsets().back(), 1.0);
  const RowTimes times = row_times(obs, {});
  for (std::size_t c = 0; c < kChannels; ++c) {
    const auto channel = static_cast<Channel>(c);
    const NoiseImperfections noise = noise_imperfections(known, std::string(stream_of(channel)));
    if (noise.variance_by_speed == 0.0 && noise.variance_by_turn == 0.0) continue;
    const auto n = static_cast<double>(obs.rows(channel));
    double square = 0.0;
    const auto row = inflation.begin() + static_cast<std::ptrdiff_t>(obs.offsets()[c]);
    for (std::size_t k = 0; k < obs.rows(channel); ++k) {
      const MotionState s = trajectory.rates_at(time_of_row(times, channel, k));
      double& own = row[static_cast<std::ptrdiff_t>(k)];
      own = std::exp(0.5 * noise.variance_by_speed * std::abs(s.speed) +
                     0.5 * noise.variance_by_turn * std::abs(s.yaw_rate));
      square += own * own / n;
    }
    for (std::size_t k = 0; k < obs.rows(channel); ++k)
      row[static_cast<std::ptrdiff_t>(k)] /= std::sqrt(square);
  }
  return inflation;
}

// Windows that read one level of coarse readings say together what one does.
void inflate_alike(const Observations& obs, std::vector<double>& inflation) {
  const auto inflate = [&](Channel channel, const std::vector<WindowObservation>& windows,
                           double step) {
    if (step <= 0.0) return;
    const std::vector<std::size_t> alike = windows_alike(windows, step);
    const std::size_t first = obs.offsets()[index_of(channel)];
    for (std::size_t k = 0; k < alike.size(); ++k)
      inflation[first + k] *= std::sqrt(static_cast<double>(alike[k]));
  };
  inflate(Channel::kSteering, obs.steering, obs.steering_step_rad);
  inflate(Channel::kGyro, obs.gyro, obs.gyro_step_rad_s);
}

void renew_noise(const Observations& obs, MotionModel& model, const HeldEffects& s, bool outliers) {
  renew_residual(obs, model);
  const PassOptions options{true, kPassProbes, &model.inflation};
  const Pass pass = run_pass(obs, model.point, model.noise, s.library.columns, options);
  const Normal normal = normal_equations(pass.innovations, s.library.columns.count());
  const std::vector<double> weights = saturated_weights(normal, s, pass.innovations);
  Eigen::MatrixXd held = normal.F;
  held.diagonal() += s.precision;
  const Eigen::LDLT<Eigen::MatrixXd> solver(held);
  std::array<double, kChannels> fitted{};
  for (std::size_t c = 0; c < kChannels; ++c)
    fitted[c] = solver.solve(normal.by_channel[c]).trace();
  model.noise = renewed_noise(model.noise, pass, weights, kPassProbes, fitted);
  if (outliers) inflate_outliers(pass.innovations, weights, model.inflation);
  apply_solution(pass.elimination.back_substitute(weights), model.point.trajectory);
}

// Slip of the wheels in one place increases their random walk and the scatter of the poses, and
// makes outliers of poses there, until the place has columns. With these the noise is estimated
// again; with that noise the edges of the disc show better, so the search is repeated.
std::vector<Accepted> allow_for_places(const Observations& obs,
                                       MotionModel& model,
                                       HeldEffects& s) {
  constexpr int kRounds = 2;
  std::vector<Accepted> places;
  for (int round = 0; round < kRounds; ++round) {
    renew_residual(obs, model);
    places = slipping_places(obs, model);
    if (places.empty()) break;
    s = saturated_library(obs, model.point, places);
    renew_noise(obs, model, s, false);
  }
  return places;
}

// Log likelihood of a drive up to a constant, with the catalogued effects integrated out under
// their priors: fitted, they would absorb some of the noise.
double likelihood(const Observations& obs, const MotionModel& model, const HeldEffects& s) {
  const Innovations in =
      run_pass(obs, model.point, model.noise, s.library.columns, {false, 0, &model.inflation})
          .innovations;
  const Normal normal = normal_equations(in, s.library.columns.count());
  Eigen::MatrixXd held = normal.F;
  held.diagonal() += s.precision;
  const Eigen::LDLT<Eigen::MatrixXd> solver(held);
  double twice = normal.u.dot(solver.solve(normal.u)) - normal.squares;
  twice -= solver.vectorD().array().max(1e-300).log().sum();
  for (const Innovation& i : in.of) twice -= std::log(i.variance);
  return 0.5 * twice;
}

// Sideways slip hides in the scatter of poses, so that iterating creeps towards it for ever: the
// likelihood says how large it is, at twice as much each time until it falls and then at the top of
// the parabola through the best three. It counts as one standard error larger than that: of what
// there are few independent pieces, sizes would seem too sure.
void choose_creep(const Observations& obs, MotionModel& model, const HeldEffects& s) {
  renew_residual(obs, model);
  constexpr double kLeast = 2e-4, kMost = 1.3e-2;
  MotionModel trial = model;
  double without = 0.0, before = 0.0, best = 0.0, creep = kLeast;
  for (double next = kLeast; next < kMost; next *= 2.0) {
    trial.noise.creep_per_sqrt_m = next;
    const double l = likelihood(obs, trial, s);
    if (next > kLeast && l <= best) {
      const double bend = 2.0 * best - before - l;
      if (creep > kLeast && bend > 0.0)
        creep *= std::exp2(0.5 * (l - before) / bend + std::min(1.0 / std::sqrt(bend), 1.0));
      break;
    }
    if (next == kLeast) without = l;
    before = best;
    best = l;
    creep = next;
  }
  constexpr double kSeen = 1.0;  // [nats]
  model.noise.creep_per_sqrt_m = best > without + kSeen ? creep : kLeast;
}

// Autocorrelated errors of poses may have a cause outside of the catalogue. They count as noise
// only if the generic effects leave them too. Poses of a map are known to have such errors.
bool poses_are_correlated(const Observations& obs,
                          MotionModel& model,
                          HeldEffects& s,
                          const std::vector<Accepted>& places,
                          const std::vector<double>& known) {
  if (obs.poses_of_map) return true;
  if (model.noise.poses_are_exact() || !poses_correlate(obs, model, s)) return false;
  s = saturated_library(obs, model.point, places, true);
  model.inflation = known;
  for (const bool outliers : {false, true}) renew_noise(obs, model, s, outliers);
  return poses_correlate(obs, model, s);
}

// Speed [m/s] that the wheels read at time t by their own clock; beyond their readings none.
std::optional<double> wheel_speed(const Observations& obs, double t) {
  const auto after =
      std::upper_bound(obs.wheels.begin(), obs.wheels.end(), t,
                       [](double time, const WheelObservation& w) { return time < w.t_s; });
  if (after == obs.wheels.begin() || after == obs.wheels.end()) return std::nullopt;
  const WheelObservation& before = *std::prev(after);
  return std::abs(after->distance_m - before.distance_m) / (after->t_s - before.t_s);
}

// Turn over speed is undefined at standstill: an outlying pose moves there freely, and an error or
// a delay of a wheel has no effect.
void leave_out_steering_at_rest(Observations& obs, const Trajectory& trajectory) {
  const double least = least_steering_speed(trajectory);
  std::erase_if(obs.steering, [&](const WindowObservation& w) {
    const double t = 0.5 * (w.begin_s + w.end_s);
    return std::abs(trajectory.at(t).speed) < least || wheel_speed(obs, t).value_or(least) < least;
  });
}

}  // namespace

MotionModel nominal_model(Observations& obs, const EffectSizes& known) {
  MotionModel model;
  model.known = motion_effects_of(known);
  model.point.effects = model.known;
  model.point.trajectory = trajectory_of_poses(obs, model.known.pose.latency);
  leave_out_steering_at_rest(obs, model.point.trajectory);
  const Trajectory smooth = smoothed(model.point.trajectory);
  std::vector<double> known_rows = known_inflation(obs, smooth, weights_of(obs, smooth, known));
  inflate_alike(obs, known_rows);
  model.inflation = known_rows;
  const MotionNoise stated = stated_noise(obs);
  model.noise = stated;
  model.noise.least_gyro_rad_s = slow_noise_of_mean(windows_of_noise(obs, Channel::kGyro), smooth);
  model.noise.gyro_rad_s = std::max(model.noise.gyro_rad_s, model.noise.least_gyro_rad_s);
  HeldEffects saturated;
  std::vector<Accepted> places;
  for (int i = 0; i < kNoiseIterations; ++i) {
    // The columns move little once the trajectory has been through one fit.
    if (i < 2) saturated = saturated_library(obs, model.point);
    if (i == 2) places = allow_for_places(obs, model, saturated);
    renew_noise(obs, model, saturated, i >= kNoiseIterations / 2);
    if (i == 2) choose_creep(obs, model, saturated);
  }
  const bool correlated = poses_are_correlated(obs, model, saturated, places, known_rows);
  model.noise.gyro_rad_s = std::max(model.noise.gyro_rad_s, stated.gyro_rad_s);
  model.noise.steering_rad = std::max(model.noise.steering_rad, stated.steering_rad);
  allow_for_correlated_steering(obs, model, places);
  model.noise = loosened(model.noise);
  if (correlated) allow_for_correlated_poses(obs, model, saturated);
  fit_model(obs, model, 3);
  return model;
}

}  // namespace roadbook
