#include "diagnosis/streams/window_noise.hpp"

#include <algorithm>
#include <cmath>

#include "base/median.hpp"
#include "diagnosis/numerics/correlation_about_line.hpp"

namespace roadbook {
namespace {

MotionState state_of(const Trajectory& trajectory, const WindowObservation& w) {
  return trajectory.rates_at(0.5 * (w.begin_s + w.end_s));
}

// Curvature of the turn rate about a time [rad/s]. At a jump it is large on both sides and zero in
// the middle, so the maximum over a third of a second to either side is used.
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

// The smoother half of the windows. Where driving is rough, the readings of a window do not follow
// a line.
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

std::size_t usual_count(const std::vector<const WindowObservation*>& windows) {
  if (windows.empty()) return 0;
  std::vector<double> counts;
  for (const auto* w : windows) counts.push_back(static_cast<double>(w->count));
  return static_cast<std::size_t>(median(std::move(counts)));
}

constexpr std::size_t kFewestWindows = 50;

std::vector<VarianceSample> looks_at(const std::vector<const WindowObservation*>& windows,
                                     const Trajectory& smooth) {
  std::vector<VarianceSample> looks;
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
  const std::vector<VarianceSample> looks = looks_at(smooth_windows(windows, smooth), smooth);
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
  // The larger of both one-sided errors: towards a correlation of 1 the scatter about the line
  // vanishes. A ratio above the largest possible one is noise.
  const double told = std::min(ratio, ratio_of_correlation(size, usual));
  const double error = std::max(correlation_of_ratio(told + sigma, usual) - size,
                                size - correlation_of_ratio(told - sigma, usual));
  return noise_cause(effect, "1", size - known, error,
                     (ratio - ratio_of_correlation(known, usual)) / sigma);
}

namespace {

// Corrects a correlation for small outliers that were not removed; they do not correlate with their
// neighbours. With outliers ten times the noise, correlations of 0.4 to 0.9 come out too small by
// 3.3 times the share of outliers, up to a share of 10 % (simulated).
NoiseCause beside_small_outliers(const NoiseCause& c, double known, double share) {
  constexpr double kLost = 3.3;
  constexpr double kMostLost = 0.5;
  constexpr double kHighest = 0.99;
  const double kept = 1.0 - std::min(kLost * share, kMostLost);
  const double told = known + c.size;
  const double size = std::min(told / kept, kHighest);
  const double sigma = std::hypot(c.sigma / kept, 0.5 * (size - told));
  return noise_cause(c.effect, "1", size - known, sigma,
                     known > 0.0 ? (size - known) / sigma : c.z);
}

// The selected windows, scaled to equal variance; otherwise the noisiest would dominate.
struct EvenWindows {
  std::vector<WindowObservation> windows;
  std::vector<VarianceSample> looks;
};

EvenWindows evened(const std::vector<const WindowObservation*>& kept,
                   std::vector<VarianceSample> looks,
                   const VarianceSlopes& slopes) {
  EvenWindows even{{}, std::move(looks)};
  for (std::size_t i = 0; i < kept.size(); ++i) {
    VarianceSample& look = even.looks[i];
    const double square = slopes.without(look).square;
    const double scale = square / std::max(look.square, 1e-300);
    even.windows.push_back(*kept[i]);
    even.windows.back().squares *= scale;
    even.windows.back().lagged *= scale;
    look = slopes.without(look);
  }
  return even;
}

struct OutliersAndCorrelation {
  NoiseCause share, correlation;
  std::vector<const WindowObservation*> sound;  ///< windows without outliers, if there are outliers
};

// Alternates two estimates that depend on each other. Correlated readings have fewer degrees of
// freedom about their line. Outliers are independent readings that reduce the correlation.
OutliersAndCorrelation told_apart(const std::string& stream,
                                  const EvenWindows& even,
                                  const NoiseImperfections& known) {
  constexpr int kTurns = 3;
  OutliersAndCorrelation told;
  double readings = 0.0;
  for (const WindowObservation& w : even.windows) {
    told.sound.push_back(&w);
    readings += static_cast<double>(w.count) / static_cast<double>(even.windows.size());
  }
  const std::size_t usual = usual_count(told.sound);
  told.correlation = correlation_in(stream, told.sound, known.correlation);
  for (int turn = 0; turn < kTurns; ++turn) {
    const NoiseCause& c = told.correlation;
    const double r = known.correlation + (c.z > kSureNoise ? c.size : 0.0);
    const auto [part, leverages] = freedom_of_correlated(r, usual);
    std::vector<VarianceSample> fewer = even.looks;
    for (VarianceSample& l : fewer) l.freedom *= part;
    const LookShape shape{part * (static_cast<double>(usual) - 2.0), readings, leverages};
    told.share = outliers(stream, fewer, {shape}, known.outliers);
    if (!is_sure(told.share) && known.outliers <= 0.0) break;
    const std::vector<bool> doubtful = may_hold_outliers(fewer);
    std::vector<const WindowObservation*> sound;
    for (std::size_t i = 0; i < even.windows.size(); ++i)
      if (!doubtful[i]) sound.push_back(&even.windows[i]);
    if (sound.size() < kFewestWindows) break;
    told.sound = std::move(sound);
    told.correlation = correlation_in(stream, told.sound, known.correlation);
    if (told.correlation.z < kSureNoise && known.correlation <= 0.0) break;
    told.correlation = beside_small_outliers(told.correlation, known.correlation,
                                             known.outliers + told.share.size);
  }
  return told;
}

}  // namespace

void append_window_noise(const std::string& stream,
                         const std::vector<WindowObservation>& windows,
                         const Trajectory& smooth,
                         const NoiseImperfections& known,
                         std::vector<NoiseCause>& all) {
  const auto kept = smooth_windows(windows, smooth);
  if (kept.size() < kFewestWindows) return;
  const std::vector<VarianceSample> looks = looks_at(kept, smooth);
  const VarianceSlopes slopes = variance_slopes(stream, looks, known);
  const EvenWindows even = evened(kept, looks, slopes);
  const OutliersAndCorrelation told = told_apart(stream, even, known);
  for (const NoiseCause& c : {slopes.by_speed, slopes.by_turn, told.share, told.correlation})
    all.push_back(c);
}

namespace {

constexpr std::size_t kFewestReadings =
    6;  // least number in a window: fewer show hardly any correlation about their line

// Mean square of the windows with `count` readings.
double mean_square(const std::vector<const WindowObservation*>& windows, std::size_t count) {
  double squares = 0.0;
  double number = 0.0;
  for (const auto* w : windows)
    if (w->count == count) {
      squares += w->squares;
      number += 1.0;
    }
  return number > 0.0 ? squares / number : 0.0;
}

}  // namespace

bool neighbours_correlate(const std::vector<WindowObservation>& windows, const Trajectory& smooth) {
  const auto kept = smooth_windows(windows, smooth);
  if (kept.size() < kFewestWindows) return false;
  const EvenWindows even = evened(kept, looks_at(kept, smooth), {});
  return told_apart("", even, {}).correlation.z > kSureNoise;
}

bool readings_correlate(const std::vector<WindowObservation>& windows, const Trajectory& smooth) {
  return usual_count(smooth_windows(windows, smooth)) >= kFewestReadings &&
         neighbours_correlate(windows, smooth);
}

double slow_noise_of_mean(const std::vector<WindowObservation>& windows, const Trajectory& smooth) {
  const auto kept = smooth_windows(windows, smooth);
  const std::size_t count = usual_count(kept);
  if (kept.size() < kFewestWindows || count < kFewestReadings) return 0.0;
  const EvenWindows even = evened(kept, looks_at(kept, smooth), {});
  // Outliers are independent readings and are left out.
  const auto [share, correlation, sound] = told_apart("", even, {});
  if (correlation.z <= kSureNoise) return 0.0;
  // Underestimated noise would show as effects, so the upper end of the interval is used. Few
  // readings cannot distinguish correlations above this limit.
  constexpr double kHighest = 0.95;
  const double r = std::min(correlation.size + correlation.sigma, kHighest);
  const double square = mean_square(sound, count);
  const double variance = square / square_about_line(r, count);
  const double of_outliers =
      std::max(0.0, mean_square(kept, count) - square) / (static_cast<double>(count) - 2.0);
  return std::sqrt((variance * (1.0 + r) / (1.0 - r) + of_outliers) / static_cast<double>(count));
}

}  // namespace roadbook
