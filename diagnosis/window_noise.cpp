#include "diagnosis/window_noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/median.hpp"

namespace roadbook {
namespace {

MotionState state_of(const Trajectory& trajectory, const WindowObservation& w) {
  return trajectory.rates_at(0.5 * (w.begin_s + w.end_s));
}

// How much the turn rate bends about a moment [rad/s]. Where it jumps it bends on both sides of the
// jump and not in its middle: the most of a third of a second to either side.
double bend_about(const Trajectory& smooth, double t_s) {
  const double h = 2.0 * smooth.step_s();
  double most = 0.0;
  for (int side = -2; side <= 2; ++side) {
    const double t = t_s + side * h;
    most = std::max(most,
                    std::abs(smooth.rates_at(t + h).yaw_rate - 2.0 * smooth.rates_at(t).yaw_rate +
                             smooth.rates_at(t - h).yaw_rate));
  }
  return most;
}

// Steering and gyro: scatter about a line within windows. Where driving is rough the line itself
// bends; the smoother half of the windows is looked at.
std::vector<const WindowObservation*> smooth_windows(const std::vector<WindowObservation>& windows,
                                                     const Trajectory& smooth) {
  std::vector<std::pair<double, const WindowObservation*>> rough;
  for (const WindowObservation& w : windows) {
    if (w.count < 4) continue;
    rough.emplace_back(bend_about(smooth, 0.5 * (w.begin_s + w.end_s)), &w);
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

// Of squares about a line through `count` readings, beside white ones: the share of the degrees of
// freedom that is left (squared trace over the trace of the square), and a reading's part in a
// square over that of a degree.
struct CorrelatedFreedom {
  double part = 1.0;
  std::vector<double> leverages;
};

CorrelatedFreedom freedom_of_correlated(double correlation, std::size_t count) {
  const double white = static_cast<double>(count) - 2.0;
  const Eigen::MatrixXd alone = about_line(0.0, count);
  const Eigen::MatrixXd S = about_line(std::max(correlation, 0.0), count);
  const double freedom = S.trace() * S.trace() / S.squaredNorm();
  CorrelatedFreedom left{freedom / white, {}};
  // A line looks alike from both ends.
  for (std::size_t i = 0; i < (count + 1) / 2; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    left.leverages.push_back(alone(at, at) * freedom / S.trace());
  }
  return left;
}

std::size_t usual_count(const std::vector<const WindowObservation*>& windows) {
  std::vector<double> counts;
  for (const auto* w : windows) counts.push_back(static_cast<double>(w->count));
  return static_cast<std::size_t>(median(std::move(counts)));
}

constexpr std::size_t kFewestWindows = 50;

std::vector<ScatterLook> looks_at(const std::vector<const WindowObservation*>& windows,
                                  const Trajectory& smooth) {
  std::vector<ScatterLook> looks;
  for (const auto* w : windows) {
    const MotionState s = state_of(smooth, *w);
    const double freedom = static_cast<double>(w->count) - 2.0;
    looks.push_back({w->squares / freedom, freedom, std::abs(s.speed), std::abs(s.yaw_rate)});
  }
  return looks;
}

}  // namespace

VarianceSlopes window_slopes(const std::string& stream,
                             const std::vector<WindowObservation>& windows,
                             const Trajectory& smooth,
                             const NoiseImperfections& known) {
  const std::vector<ScatterLook> looks = looks_at(smooth_windows(windows, smooth), smooth);
  if (looks.size() >= kFewestWindows) return variance_slopes(stream, looks, known);
  VarianceSlopes slopes;
  slopes.speed = known.variance_by_speed;
  slopes.turn = known.variance_by_turn;
  return slopes;
}

NoiseCause correlation_in(const std::string& stream,
                          const std::vector<const WindowObservation*>& windows,
                          double known) {
  const std::string effect = stream + ".correlation";
  if (windows.size() < kFewestWindows) return noise_cause(effect, "1", 0.0, 0.0, 0.0);
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
  // The wider of both sides: towards 1 readings hardly scatter about their line any more. What is
  // beyond the highest ratio that a correlation has is chance.
  const double told = std::min(ratio, ratio_of_correlation(size, usual));
  const double error = std::max(correlation_of_ratio(told + sigma, usual) - size,
                                size - correlation_of_ratio(told - sigma, usual));
  return noise_cause(effect, "1", size - known, error,
                     (ratio - ratio_of_correlation(known, usual)) / sigma);
}

namespace {

// Outliers that happen to be small stay in: with 5 % of them a correlation of 0.7 comes out as
// 0.53, with 3 % one of 0.4 as 0.34 (simulated).
NoiseCause beside_small_outliers(const NoiseCause& c, double known) {
  constexpr double kLost = 0.25;
  const double sigma = std::hypot(c.sigma, kLost * (known + c.size));
  return noise_cause(c.effect, "1", c.size, sigma, known > 0.0 ? c.size / sigma : c.z);
}

// Of windows and looks whose variance is the same throughout. Readings that go together have fewer
// degrees of freedom about their line; an outlier is a reading of its own, and where there are
// some, neighbours seem to have less in common: one is found beside the other, by turns.
void add_outliers_and_correlation(const std::string& stream,
                                  const std::vector<WindowObservation>& windows,
                                  const std::vector<ScatterLook>& looks,
                                  const NoiseImperfections& known,
                                  std::vector<NoiseCause>& all) {
  constexpr int kTurns = 3;
  std::vector<const WindowObservation*> alike;
  double readings = 0.0;
  for (const WindowObservation& w : windows) {
    alike.push_back(&w);
    readings += static_cast<double>(w.count) / static_cast<double>(windows.size());
  }
  const std::size_t usual = usual_count(alike);
  NoiseCause correlation = correlation_in(stream, alike, known.correlation);
  NoiseCause share;
  for (int turn = 0; turn < kTurns; ++turn) {
    const double r = known.correlation + (correlation.z > kSureNoise ? correlation.size : 0.0);
    const auto [part, leverages] = freedom_of_correlated(r, usual);
    std::vector<ScatterLook> fewer = looks;
    for (ScatterLook& l : fewer) l.freedom *= part;
    const LookShape shape{part * (static_cast<double>(usual) - 2.0), readings, leverages};
    share = outliers(stream, fewer, shape, known.outliers);
    if (!is_sure(share) && known.outliers <= 0.0) break;
    const std::vector<bool> doubtful = may_hold_outliers(fewer);
    alike.clear();
    for (std::size_t i = 0; i < windows.size(); ++i)
      if (!doubtful[i]) alike.push_back(&windows[i]);
    correlation = correlation_in(stream, alike, known.correlation);
    if (correlation.z < kSureNoise && known.correlation <= 0.0) break;
    correlation = beside_small_outliers(correlation, known.correlation);
  }
  all.push_back(share);
  all.push_back(correlation);
}

}  // namespace

void look_into_windows(const std::string& stream,
                       const std::vector<WindowObservation>& windows,
                       const Trajectory& smooth,
                       const NoiseImperfections& known,
                       std::vector<NoiseCause>& all) {
  const auto kept = smooth_windows(windows, smooth);
  std::vector<ScatterLook> looks = looks_at(kept, smooth);
  if (looks.size() < kFewestWindows) return;
  const VarianceSlopes slopes = variance_slopes(stream, looks, known);
  all.push_back(slopes.by_speed);
  all.push_back(slopes.by_turn);
  // Each by its own variance, or the noisiest would speak for all.
  std::vector<WindowObservation> even;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const double scale = slopes.without(looks[i]).square / std::max(looks[i].square, 1e-300);
    even.push_back(*kept[i]);
    even.back().squares *= scale;
    even.back().lagged *= scale;
  }
  for (ScatterLook& l : looks) l = slopes.without(l);
  add_outliers_and_correlation(stream, even, looks, known, all);
}

bool neighbours_correlate(const std::vector<WindowObservation>& windows, const Trajectory& smooth) {
  return correlation_in("", smooth_windows(windows, smooth)).z > kSureNoise;
}

bool readings_correlate(const std::vector<WindowObservation>& windows, const Trajectory& smooth) {
  constexpr std::size_t kFewestReadings = 6;  // fewer hardly correlate about their line
  return neighbours_correlate(windows, smooth) &&
         usual_count(smooth_windows(windows, smooth)) >= kFewestReadings;
}

double slow_noise_of_mean(const std::vector<WindowObservation>& windows, const Trajectory& smooth) {
  if (!readings_correlate(windows, smooth)) return 0.0;
  const auto kept = smooth_windows(windows, smooth);
  const std::size_t count = usual_count(kept);
  // Too little noise shows as causes: the larger of what the readings may have. So few hardly tell
  // what is beyond the highest.
  constexpr double kHighest = 0.95;
  const NoiseCause correlation = correlation_in("", kept);
  const double r = std::min(correlation.size + correlation.sigma, kHighest);
  double square = 0.0;
  for (const auto* w : kept) square += w->squares / static_cast<double>(kept.size());
  const double variance = square / about_line(r, count).trace();
  return std::sqrt(variance * (1.0 + r) / (1.0 - r) / static_cast<double>(count));
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
