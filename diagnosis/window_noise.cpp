#include "diagnosis/window_noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

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

// Covariance of deviations from a line through `count` readings of AR(1) noise of unit variance.
Eigen::MatrixXd about_line(double correlation, std::size_t count) {
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
  return left * covariance * left;
}

std::size_t usual_count(const std::vector<const WindowObservation*>& windows) {
  std::vector<double> counts;
  for (const auto* w : windows) counts.push_back(static_cast<double>(w->count));
  return static_cast<std::size_t>(median(std::move(counts)));
}

}  // namespace

NoiseCause correlation_in(const std::string& stream,
                          const std::vector<const WindowObservation*>& windows) {
  const std::string effect = stream + ".correlation";
  if (windows.size() < 50) return noise_cause(effect, "1", 0.0, 0.0, 0.0);
  const std::size_t usual = usual_count(windows);
  double lagged = 0.0;
  double squares = 0.0;
  for (const auto* w : windows)
    if (w->count == usual) {
      lagged += w->lagged;
      squares += w->squares;
    }
  if (squares <= 0.0) return noise_cause(effect, "1", 0.0, 0.0, 0.0);
  const double ratio = lagged / squares;
  double scatter = 0.0;
  for (const auto* w : windows)
    if (w->count == usual) scatter += std::pow((w->lagged - ratio * w->squares) / squares, 2);
  const double sigma = std::sqrt(scatter);
  const double size = correlation_of_ratio(ratio, usual);
  const double slope = (correlation_of_ratio(ratio + sigma, usual) - size) / sigma;
  return noise_cause(effect, "1", size, std::abs(slope) * sigma,
                     (ratio - ratio_of_correlation(0.0, usual)) / sigma);
}

void look_into_windows(const std::string& stream,
                       const std::vector<WindowObservation>& windows,
                       const Trajectory& smooth,
                       std::vector<NoiseCause>& all) {
  const auto kept = smooth_windows(windows, smooth);
  std::vector<ScatterLook> looks;
  double readings = 0.0;
  for (const auto* w : kept) {
    const MotionState s = state_of(smooth, *w);
    const double freedom = static_cast<double>(w->count) - 2.0;
    looks.push_back({w->squares / freedom, freedom, std::abs(s.speed), std::abs(s.yaw_rate)});
    readings += static_cast<double>(w->count) / static_cast<double>(kept.size());
  }
  if (looks.size() < 50) return;
  all.push_back(outliers(stream, looks, readings));
  all.push_back(variance_by(stream, "speed", "s/m", looks, &ScatterLook::speed));
  all.push_back(variance_by(stream, "turn", "s/rad", looks, &ScatterLook::turn));
  all.push_back(correlation_in(stream, kept));
}

bool readings_correlate(const std::vector<WindowObservation>& windows, const Trajectory& smooth) {
  constexpr double kSure = 4.0;       // [sigma]
  constexpr std::size_t kFewest = 6;  // readings: fewer hardly correlate about their line
  const auto kept = smooth_windows(windows, smooth);
  return correlation_in("", kept).z > kSure && usual_count(kept) >= kFewest;
}

double ratio_of_correlation(double correlation, std::size_t count) {
  const Eigen::MatrixXd S = about_line(correlation, count);
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

}  // namespace roadbook
