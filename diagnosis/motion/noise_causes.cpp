#include "diagnosis/motion/noise_causes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/median.hpp"
#include "diagnosis/motion/wheel_noise.hpp"
#include "diagnosis/streams/coarse_readings.hpp"
#include "diagnosis/streams/variance_samples.hpp"
#include "diagnosis/streams/window_noise.hpp"

namespace roadbook {
namespace {

// Lag-one correlation of the innovations, all pose channels together.
NoiseCause pose_correlation(const std::array<std::vector<double>, 3>& channels, double known) {
  double n = 0.0, r = 0.0, of_channels = 0.0;
  std::vector<double> each;
  for (const auto& e : channels) {
    if (e.size() < 50) continue;
    double lagged = 0.0, squares = 0.0;
    for (std::size_t i = 1; i < e.size(); ++i) {
      lagged += e[i] * e[i - 1];
      squares += e[i] * e[i];
    }
    n += static_cast<double>(e.size());
    each.push_back(lagged / std::max(squares, 1e-300));
    of_channels += 1.0;
  }
  if (n < 100.0) return noise_cause("poses.correlation", "1", 0.0, 0.0, 0.0);
  for (const double v : each) r += v / of_channels;
  // Of each channel the trajectory takes another part of the errors: their scatter counts, too.
  double scatter = 0.0;
  for (const double v : each) scatter += (v - r) * (v - r) / std::max(1.0, of_channels - 1.0);
  const double sigma = std::sqrt(std::max(std::max(1.0 - r * r, 0.05) / n, scatter / of_channels));
  const double null_sigma = std::sqrt(std::max(1.0 / n, scatter / of_channels));
  if (known != 0.0)
    return noise_cause("poses.correlation", "1", r - known, sigma, (r - known) / sigma);
  return noise_cause("poses.correlation", "1", r, sigma, r / null_sigma);
}

// If a whole pose is an outlier, its three rows are. If one axis of a map is, two rows show it, and
// shares come out slightly too large (docs/results/diagnosis.md).
NoiseCause pose_outliers(const std::vector<VarianceSample>& looks, double known) {
  constexpr double kOfAxes = 0.05;
  const NoiseCause c = outliers("poses", looks, {LookShape{}}, known);
  const double sigma = std::hypot(std::sqrt(3.0) * c.sigma, kOfAxes * (known + c.size));
  return with_sigma(c, sigma, known);
}

// Each channel by its own scale: where correlated errors were allowed for, scales differ.
std::vector<VarianceSample> of_equal_scale(
    const std::array<std::vector<VarianceSample>, 3>& by_channel) {
  std::vector<VarianceSample> looks;
  for (const auto& of : by_channel) {
    std::vector<double> squares;
    for (const VarianceSample& l : of) squares.push_back(l.square);
    if (squares.size() < 20) continue;
    const double scale = std::max(median(squares) / median_share(1.0), 1e-300);
    for (VarianceSample l : of) {
      l.square /= scale;
      looks.push_back(l);
    }
  }
  return looks;
}

// Where neighbours correlate: squares of what the innovation before does not predict, in place of
// those of the innovations. False where they do not.
bool keep_steps(const std::vector<double>& e, std::vector<VarianceSample>& looks) {
  constexpr double kSignificant = 5.0;
  double lagged = 0.0, squares = 0.0;
  for (std::size_t i = 1; i < e.size(); ++i) {
    lagged += e[i] * e[i - 1];
    squares += e[i] * e[i];
  }
  const double r = lagged / std::max(squares, 1e-300);
  if (r * std::sqrt(static_cast<double>(e.size())) <= kSignificant) return false;
  for (std::size_t i = e.size(); i-- > 1;) {
    const double grown = std::sqrt(looks[i].square / std::max(e[i] * e[i], 1e-300));
    looks[i].square = std::pow(grown * (e[i] - r * e[i - 1]), 2);
  }
  looks.erase(looks.begin());
  return true;
}

void look_into_poses(const Observations& obs,
                     const MotionModel& model,
                     const Trajectory& smooth,
                     const NoiseImperfections& known,
                     std::vector<NoiseCause>& all) {
  Columns none;
  const Innovations in =
      run_pass(obs, model.point, model.noise, none, {false, 0, &model.inflation}).innovations;
  std::array<std::vector<VarianceSample>, 3> by_channel;
  std::array<std::vector<double>, 3> channels;
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    const Innovation& row = in.of[i];
    if (row.channel < index_of(Channel::kPoseAlong) || row.variance > kVague) continue;
    const std::size_t c = row.channel - index_of(Channel::kPoseAlong);
    const double e = in.row(i)[0] * model.inflation[row.row];
    const MotionState s = smooth.rates_at(row.t_s);
    by_channel[c].push_back({e * e, 1.0, std::abs(s.speed), std::abs(s.yaw_rate)});
    channels[c].push_back(in.row(i)[0]);
  }
  const NoiseCause correlation = pose_correlation(channels, known.correlation);
  std::vector<VarianceSample> looks = of_equal_scale(by_channel);
  if (looks.size() < 50) return;
  const VarianceSlopes slopes = variance_slopes("poses", looks, known);
  for (VarianceSample& l : looks) l = slopes.without(l);
  std::array<NoiseCause, 3> found{slopes.by_speed, slopes.by_turn,
                                  pose_outliers(looks, known.outliers)};
  // A few long swings of errors that last look like scatter of another kind: what is there shows in
  // the steps from pose to pose as well.
  bool last = false;
  for (std::size_t c = 0; c < 3; ++c) last |= keep_steps(channels[c], by_channel[c]);
  if (last) {
    looks = of_equal_scale(by_channel);
    const VarianceSlopes of_steps = variance_slopes("poses", looks, known);
    for (VarianceSample& l : looks) l = of_steps.without(l);
    const std::array<NoiseCause, 3> again{of_steps.by_speed, of_steps.by_turn,
                                          pose_outliers(looks, known.outliers)};
    for (std::size_t i = 0; i < found.size(); ++i)
      if (std::abs(again[i].z) < std::abs(found[i].z)) found[i] = again[i];
  }
  all.insert(all.end(), found.begin(), found.end());
  all.push_back(correlation);
}

}  // namespace

std::vector<NoiseCause> noise_causes(const Observations& obs,
                                     const MotionModel& model,
                                     const NoiseOptions& options) {
  const Trajectory smooth = smoothed(model.point.trajectory);
  std::vector<NoiseCause> all;
  const auto known = [&](const std::string& stream) {
    return noise_imperfections(options.known, stream);
  };
  const Trajectory of_poses = smoothed(trajectory_of_poses(obs));
  for (const Channel channel : {Channel::kGyro, Channel::kSteering}) {
    const std::string stream(stream_of(channel));
    append_window_noise(stream, windows_of_noise(obs, channel), of_poses, known(stream), all);
  }
  look_into_wheels(obs, model, known("wheels0"), all);
  if (!model.noise.poses_are_exact()) look_into_poses(obs, model, smooth, known("poses"), all);
  const auto tests = static_cast<double>(all.size());
  std::vector<NoiseCause> found;
  for (NoiseCause& c : all) {
    c.p = std::min(1.0, c.p * tests);
    // Correlated noise below zero is no sensor's; shares are positive.
    const bool one_sided = c.effect.ends_with("correlation") && !options.known.contains(c.effect);
    if (c.p < options.max_p && !(one_sided && c.z < 0.0)) found.push_back(c);
  }
  std::stable_sort(found.begin(), found.end(), [](const NoiseCause& a, const NoiseCause& b) {
    return std::abs(a.z) > std::abs(b.z);
  });
  return found;
}

}  // namespace roadbook
