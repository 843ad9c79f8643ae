#include "diagnosis/noise_causes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "diagnosis/score_table.hpp"

namespace roadbook {
namespace {

// One independent look at a stream's variance: a mean of squares with so many degrees of freedom.
struct Look {
  double square = 0.0;
  double freedom = 1.0;
  double speed = 0.0;
  double turn = 0.0;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median of chi-squared over its degrees of freedom (Wilson and Hilferty).
double median_share(double freedom) {
  const double a = 1.0 - 2.0 / (9.0 * freedom);
  return a * a * a;
}

NoiseCause cause(const std::string& effect, const char* unit, double size, double sigma, double z) {
  return {effect, unit, size, sigma, z, std::erfc(std::abs(z) / std::sqrt(2.0))};
}

// Regression of log squares on a covariate: a few outliers move a logarithm little. The scatter
// about the line is measured, not assumed.
NoiseCause variance_by(const std::string& stream,
                       const char* name,
                       const char* unit,
                       const std::vector<Look>& looks,
                       double Look::*covariate) {
  double n = 0.0, sx = 0.0, sy = 0.0;
  for (const Look& l : looks) {
    n += 1.0;
    sx += l.*covariate;
    sy += std::log(l.square + 1e-300);
  }
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Look& l : looks) {
    const double x = l.*covariate - sx / n;
    const double y = std::log(l.square + 1e-300) - sy / n;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  const std::string effect = stream + ".variance(" + name + ")";
  // A covariate that hardly moves tells nothing.
  if (n < 50.0 || xx / n < 1e-4) return cause(effect, unit, 0.0, 0.0, 0.0);
  const double slope = xy / xx;
  const double sigma = std::sqrt((yy - slope * xy) / (n - 2.0) / xx);
  return cause(effect, unit, slope, sigma, slope / sigma);
}

// Looks far beyond what their degrees of freedom allow, against how many chance would give.
NoiseCause outliers(const std::string& stream,
                    const std::vector<Look>& looks,
                    double readings_a_look) {
  constexpr double kChance = 1e-5;
  std::vector<double> scaled;
  for (const Look& l : looks) scaled.push_back(l.square / median_share(l.freedom));
  const double scale = scaled.empty() ? 1.0 : std::max(median(scaled), 1e-300);
  double count = 0.0;
  for (const Look& l : looks)
    if (chi_squared_tail(l.square / scale * l.freedom, static_cast<int>(l.freedom)) < kChance)
      count += 1.0;
  const auto n = static_cast<double>(looks.size());
  // Poisson tail as the equivalent normal deviate; one or two such looks name nothing.
  double tail = 1.0;
  double term = std::exp(-n * kChance);
  for (double k = 0.0; k < count; k += 1.0) {
    tail -= term;
    term *= n * kChance / (k + 1.0);
  }
  const double share = count / (n * readings_a_look);
  NoiseCause c = cause(stream + ".outliers", "1", share,
                       std::sqrt(std::max(count, 1.0)) / (n * readings_a_look), 0.0);
  c.p = count < 3.0 ? 1.0 : std::max(tail, 1e-15);
  c.z = count < 3.0 ? 0.0 : std::sqrt(2.0 * count * std::log(std::max(count / (n * kChance), 1.0)));
  return c;
}

MotionState state_of(const Trajectory& trajectory, const WindowObservation& w) {
  return trajectory.rates_at(0.5 * (w.begin_s + w.end_s));
}

// Steering and gyro: scatter about a line within windows. Where driving is rough the line itself
// bends; the smoother half of the windows is looked at.
std::vector<const WindowObservation*> smooth_windows(const std::vector<WindowObservation>& windows,
                                                     const Trajectory& smooth) {
  std::vector<std::pair<double, const WindowObservation*>> rough;
  for (const WindowObservation& w : windows) {
    if (w.count < 4) continue;
    const double middle = 0.5 * (w.begin_s + w.end_s);
    const double h = smooth.step_s();
    const double bend = smooth.rates_at(middle + 2.0 * h).yaw_rate -
                        2.0 * smooth.rates_at(middle).yaw_rate +
                        smooth.rates_at(middle - 2.0 * h).yaw_rate;
    rough.emplace_back(std::abs(bend), &w);
  }
  std::stable_sort(rough.begin(), rough.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const WindowObservation*> kept;
  for (std::size_t i = 0; i < rough.size() / 2; ++i) kept.push_back(rough[i].second);
  return kept;
}

NoiseCause correlation(const std::string& stream,
                       const std::vector<const WindowObservation*>& windows) {
  const std::string effect = stream + ".correlation";
  if (windows.size() < 50) return cause(effect, "1", 0.0, 0.0, 0.0);
  std::vector<double> counts;
  for (const auto* w : windows) counts.push_back(static_cast<double>(w->count));
  const auto usual = static_cast<std::size_t>(median(counts));
  double lagged = 0.0;
  double squares = 0.0;
  for (const auto* w : windows)
    if (w->count == usual) {
      lagged += w->lagged;
      squares += w->squares;
    }
  if (squares <= 0.0) return cause(effect, "1", 0.0, 0.0, 0.0);
  const double ratio = lagged / squares;
  double scatter = 0.0;
  for (const auto* w : windows)
    if (w->count == usual) scatter += std::pow((w->lagged - ratio * w->squares) / squares, 2);
  const double sigma = std::sqrt(scatter);
  const double size = correlation_of_ratio(ratio, usual);
  const double slope = (correlation_of_ratio(ratio + sigma, usual) - size) / sigma;
  return cause(effect, "1", size, std::abs(slope) * sigma,
               (ratio - ratio_of_correlation(0.0, usual)) / sigma);
}

void look_into_windows(const std::string& stream,
                       const std::vector<WindowObservation>& windows,
                       const Trajectory& smooth,
                       std::vector<NoiseCause>& all) {
  const auto kept = smooth_windows(windows, smooth);
  std::vector<Look> looks;
  double readings = 0.0;
  for (const auto* w : kept) {
    const MotionState s = state_of(smooth, *w);
    const double freedom = static_cast<double>(w->count) - 2.0;
    looks.push_back({w->squares / freedom, freedom, std::abs(s.speed), std::abs(s.yaw_rate)});
    readings += static_cast<double>(w->count) / static_cast<double>(kept.size());
  }
  if (looks.size() < 50) return;
  all.push_back(outliers(stream, looks, readings));
  all.push_back(variance_by(stream, "speed", "s/m", looks, &Look::speed));
  all.push_back(variance_by(stream, "turn", "s/rad", looks, &Look::turn));
  all.push_back(correlation(stream, kept));
}

// Lag-one correlation of the innovations, all pose channels together.
NoiseCause pose_correlation(const std::array<std::vector<double>, 3>& channels) {
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
  if (n < 100.0) return cause("poses.correlation", "1", 0.0, 0.0, 0.0);
  for (const double v : each) r += v / of_channels;
  // Of each channel the trajectory takes another part of the errors: their scatter counts, too.
  double scatter = 0.0;
  for (const double v : each) scatter += (v - r) * (v - r) / std::max(1.0, of_channels - 1.0);
  const double sigma = std::sqrt(std::max(std::max(1.0 - r * r, 0.05) / n, scatter / of_channels));
  const double null_sigma = std::sqrt(std::max(1.0 / n, scatter / of_channels));
  return cause("poses.correlation", "1", r, sigma, r / null_sigma);
}

void look_into_poses(const Observations& obs,
                     const MotionModel& model,
                     const Trajectory& smooth,
                     std::vector<NoiseCause>& all) {
  Columns none;
  const Innovations in =
      run_pass(obs, model.point, model.noise, none, {false, 0, &model.inflation}).innovations;
  std::array<std::vector<Look>, 3> by_channel;
  std::array<std::vector<double>, 3> channels;
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    const Innovation& row = in.of[i];
    constexpr double kVague = 3.0;
    if (row.channel < index_of(Channel::kPoseAlong) || row.variance > kVague) continue;
    const std::size_t c = row.channel - index_of(Channel::kPoseAlong);
    const double e = in.row(i)[0] * model.inflation[row.row];
    const MotionState s = smooth.rates_at(row.t_s);
    by_channel[c].push_back({e * e, 1.0, std::abs(s.speed), std::abs(s.yaw_rate)});
    channels[c].push_back(in.row(i)[0]);
  }
  // Each channel by its own scale: where correlated errors were allowed for, scales differ.
  std::vector<Look> looks;
  for (const auto& of : by_channel) {
    std::vector<double> squares;
    for (const Look& l : of) squares.push_back(l.square);
    if (squares.size() < 20) continue;
    const double scale = std::max(median(squares) / median_share(1.0), 1e-300);
    for (Look l : of) {
      l.square /= scale;
      looks.push_back(l);
    }
  }
  if (looks.size() < 50) return;
  all.push_back(outliers("poses", looks, 1.0));
  all.push_back(variance_by("poses", "speed", "s/m", looks, &Look::speed));
  all.push_back(variance_by("poses", "turn", "s/rad", looks, &Look::turn));
  all.push_back(pose_correlation(channels));
}

}  // namespace

double ratio_of_correlation(double correlation, std::size_t count) {
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd covariance(n, n);
  Eigen::MatrixXd line(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    line.row(i) << 1.0, static_cast<double>(i);
    for (Eigen::Index j = 0; j < n; ++j)
      covariance(i, j) = std::pow(correlation, static_cast<double>(std::abs(i - j)));
  }
  const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(n, n) -
                               line * (line.transpose() * line).inverse() * line.transpose();
  const Eigen::MatrixXd S = left * covariance * left;
  return S.diagonal(1).sum() / S.trace();
}

double correlation_of_ratio(double ratio, std::size_t count) {
  double low = 0.0;
  double high = 0.99;
  if (ratio <= ratio_of_correlation(low, count)) return low;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (ratio_of_correlation(middle, count) < ratio ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::vector<NoiseCause> noise_causes(const Observations& obs,
                                     const MotionModel& model,
                                     const NoiseOptions& options) {
  const Trajectory smooth = smoothed(model.point.trajectory);
  std::vector<NoiseCause> all;
  look_into_windows("imu0", obs.gyro, smooth, all);
  look_into_windows("steering0", obs.steering, smooth, all);
  if (!model.noise.poses_are_exact()) look_into_poses(obs, model, smooth, all);
  const auto tests = static_cast<double>(all.size());
  std::vector<NoiseCause> found;
  for (NoiseCause& c : all) {
    c.p = std::min(1.0, c.p * tests);
    // Correlated noise below zero is no sensor's; shares are positive.
    const bool one_sided = c.effect.ends_with("correlation");
    if (c.p < options.max_p && !(one_sided && c.z < 0.0)) found.push_back(c);
  }
  std::stable_sort(found.begin(), found.end(), [](const NoiseCause& a, const NoiseCause& b) {
    return std::abs(a.z) > std::abs(b.z);
  });
  // One name a stream: what is left of the others is looked at when it is in the model.
  std::vector<NoiseCause> first;
  for (const NoiseCause& c : found) {
    const auto stream = c.effect.substr(0, c.effect.find('.'));
    const bool named = std::any_of(first.begin(), first.end(), [&](const NoiseCause& f) {
      return f.effect.starts_with(stream + ".");
    });
    if (!named) first.push_back(c);
  }
  return first;
}

}  // namespace roadbook
