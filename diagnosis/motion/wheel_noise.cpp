#include "diagnosis/motion/wheel_noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "diagnosis/motion/wheel_scores.hpp"
#include "diagnosis/streams/variance_samples.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kFewestWheelWindows = 50;
// What scatters by less was computed, not read: no encoder resolves it, and how it rounds is no
// noise.
constexpr double kFinestReading_rad = 1e-6;

// What every fit is free in.
FreeParameters always_free(const WheelParameters& p) {
  FreeParameters free;
  free.reserve(kWheelParameters);
  for (const Eigen::Index i : {kAlongWalk, kHeadingWalk, kReadingNoise}) free.push_back(i);
  if (p[kOutlierOdds] > kNoOutliers) free.push_back(kOutlierOdds);
  return free;
}

// Score test of a further parameter at a fit of the free ones, by the scatter that the windows'
// scores really have; size and its error of the fit with it.
NoiseCause further(const char* name,
                   const char* unit,
                   const std::vector<WheelWindow>& windows,
                   const WheelParameters& null,
                   FreeParameters free,
                   WheelParameter tested) {
  const std::string effect = std::string("wheels0.variance(") + name + ")";
  const WheelScores at = wheel_scores(windows, null);
  const FreeParameters alone{tested};
  const Eigen::VectorXd beside =
      at.information(free, free).ldlt().solve(at.information(free, alone)).col(0);
  WheelParameters direction = WheelParameters::Unit(tested);
  direction(free) = -beside;
  const double scatter = direction.dot(at.scatter * direction);
  const double told = direction.dot(at.information * direction);
  if (!(told > 1e-2 * at.information(tested, tested)) || !(scatter > 0.0))
    return noise_cause(effect, unit, 0.0, 0.0, 0.0);
  const double z = direction.dot(at.sum) / std::sqrt(scatter);
  free.push_back(tested);
  const WheelParameters p = fitted_wheels(windows, null, free);
  const WheelScores end = wheel_scores(windows, p);
  const Eigen::MatrixXd information = end.information(free, free);
  const Eigen::MatrixXd inverse =
      information.ldlt().solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  const Eigen::MatrixXd covariance = inverse * end.scatter(free, free) * inverse;
  const double sigma = std::sqrt(covariance(covariance.rows() - 1, covariance.cols() - 1));
  return noise_cause(effect, unit, p[tested] - null[tested], sigma, z);
}

// Variance of readings by speed and by turn, each with the other in the model if that is
// significant.
struct WheelSlopes {
  WheelParameters all;  ///< with the significant effects
  NoiseCause by_speed, by_turn;
};

WheelSlopes wheel_slopes(const std::vector<WheelWindow>& windows, const WheelParameters& null) {
  const FreeParameters always = always_free(null);
  const auto by_speed = [&](const WheelParameters& at, const FreeParameters& free) {
    NoiseCause c = further("speed", "s/m", windows, at, free, kBySpeed);
    // Noise that decreases with speed looks like autocorrelation of neighbours: with the random
    // walk of a rolling wheel the two are not separable, so neither is reported.
    return c.z < 0.0 ? noise_cause(c.effect, "s/m", 0.0, 0.0, 0.0) : c;
  };
  const auto by_turn = [&](const WheelParameters& at, const FreeParameters& free) {
    return further("turn", "s/rad", windows, at, free, kByTurn);
  };
  WheelSlopes s{null, by_speed(null, always), by_turn(null, always)};
  const bool speed_first = std::abs(s.by_speed.z) > std::abs(s.by_turn.z);
  for (const bool speed : {speed_first, !speed_first}) {
    if (!is_sure(speed ? s.by_speed : s.by_turn)) continue;
    FreeParameters free = always;
    free.push_back(speed ? kBySpeed : kByTurn);
    const WheelParameters with = fitted_wheels(windows, null, free);
    if (speed)
      s.by_turn = by_turn(with, free);
    else
      s.by_speed = by_speed(with, free);
  }
  FreeParameters sure = always;
  if (is_sure(s.by_speed)) sure.push_back(kBySpeed);
  if (is_sure(s.by_turn)) sure.push_back(kByTurn);
  if (sure.size() > always.size()) s.all = fitted_wheels(windows, null, sure);
  return s;
}

// Part of a window's square that comes from its readings, not from the way.
double part_of_readings(const WheelWindow& w, const WheelParameters& p) {
  double part = 0.0;
  for (std::size_t i = 0; i < kWheelRows; ++i)
    part += row_variance(w, i, p).part_of_readings() / static_cast<double>(kWheelRows);
  return part;
}

// By that part, each kind half of the one before: a standing wheel shows all of an outlier, one
// that rolls fast next to nothing.
constexpr std::size_t kKinds = 6;

std::size_t kind_of(const WheelWindow& w, const WheelParameters& p) {
  const double halvings = std::floor(-std::log2(std::max(part_of_readings(w, p), 1e-9)));
  return static_cast<std::size_t>(std::clamp(halvings, 0.0, static_cast<double>(kKinds - 1)));
}

std::vector<VarianceSample> looks_of(const std::vector<WheelWindow>& windows,
                                     const WheelParameters& p) {
  std::vector<VarianceSample> looks;
  for (const WheelWindow& w : windows) {
    VarianceSample look{0.0, static_cast<double>(kWheelRows), w.speed, w.turn, kind_of(w, p)};
    for (std::size_t i = 0; i < kWheelRows; ++i)
      look.square += w.square(i) / row_variance(w, i, p).total() / look.freedom;
    looks.push_back(look);
  }
  return looks;
}

// Mean change of the log variance by speed and turn, as known.
double usual_growth(const std::vector<WheelWindow>& windows, const WheelParameters& p) {
  double sum = 0.0;
  for (const WheelWindow& w : windows) sum += p[kBySpeed] * w.speed + p[kByTurn] * w.turn;
  return sum / static_cast<double>(windows.size());
}

// The shape of a window of `readings` readings; `part`: the share of them that contributes to the
// window's mean square.
LookShape shape_of(double readings, double part) {
  // For equally spaced readings about their parabola, by orthogonal polynomials; symmetric. The
  // parts add up to `part`.
  constexpr auto kReadings = static_cast<double>(kWheelWindow);
  constexpr double kMeanSquare = (kReadings * kReadings - 1.0) / 12.0;
  double fourth = 0.0;
  for (std::size_t i = 0; i < kWheelWindow; ++i) {
    const double t = static_cast<double>(i) - 0.5 * (kReadings - 1.0);
    fourth += (t * t - kMeanSquare) * (t * t - kMeanSquare);
  }
  LookShape shape{static_cast<double>(kWheelRows), readings, {}};
  for (std::size_t i = 0; i < kWheelWindow / 2; ++i) {
    const double t = static_cast<double>(i) - 0.5 * (kReadings - 1.0);
    const double bend = t * t - kMeanSquare;
    const double left =
        1.0 - 1.0 / kReadings - t * t / (kReadings * kMeanSquare) - bend * bend / fourth;
    shape.leverages.push_back(left * kReadings * part / readings);
  }
  return shape;
}

// Means of the windows of each kind: readings of one wheel while it stands, of both while they
// roll.
std::vector<LookShape> shapes_of(const std::vector<WheelWindow>& windows,
                                 const WheelParameters& p) {
  std::array<double, kKinds> count{}, readings{}, part{};
  for (const WheelWindow& w : windows) {
    const std::size_t kind = kind_of(w, p);
    count[kind] += 1.0;
    readings[kind] += w.readings;
    part[kind] += part_of_readings(w, p);
  }
  std::vector<LookShape> shapes;
  for (std::size_t k = 0; k < kKinds; ++k) {
    const double n = std::max(count[k], 1.0);
    shapes.push_back(shape_of(std::max(readings[k] / n, 1.0), part[k] / n));
  }
  return shapes;
}

// How much of a window is the way's is estimated, too. So wide, 36 of 38 intervals of laps of 64 m
// hold (docs/guide/diagnosis.md).
NoiseCause beside_walk(const NoiseCause& c,
                       const std::vector<WheelWindow>& windows,
                       const WheelParameters& p,
                       double known) {
  constexpr double kOfTheWay = 0.35;
  double way = 0.0;
  for (const WheelWindow& w : windows)
    way += (1.0 - part_of_readings(w, p)) / static_cast<double>(windows.size());
  const double sigma = std::hypot(c.sigma, kOfTheWay * way * (known + c.size));
  return with_sigma(c, sigma, known);
}

// Noise of the wheels as `windows` tell it, the known part among `start`.
struct WheelNoise {
  WheelSlopes slopes;
  NoiseCause outliers;
};

WheelNoise noise_of_wheels(const std::vector<WheelWindow>& windows,
                           WheelParameters p,
                           double known_outliers) {
  // A reading that is far off shows in the distance and in the heading: counted once.
  std::vector<WheelWindow> once = windows;
  std::erase_if(once, [](const WheelWindow& w) { return w.along; });
  const auto told_at = [&](const WheelParameters& start) {
    WheelNoise told{wheel_slopes(windows, fitted_wheels(windows, start, always_free(start))), {}};
    const WheelParameters& all = told.slopes.all;
    told.outliers = outliers("wheels0", looks_of(once, all), shapes_of(once, all), known_outliers);
    return told;
  };
  WheelNoise told = told_at(p);
  // Outliers increase the variance of readings, not that of the way, and so the part of one reading
  // in a window. With outliers, all other parameters are fitted together with them.
  if (is_sure(told.outliers) || known_outliers > 0.0) {
    const double share = std::clamp(known_outliers + told.outliers.size, 1e-3, 0.5);
    p[kOutlierOdds] = std::log(share / (1.0 - share));
    told = told_at(p);
  }
  told.outliers = beside_walk(told.outliers, once, told.slopes.all, known_outliers);
  return told;
}

}  // namespace

void look_into_wheels(const Observations& obs,
                      const MotionModel& model,
                      const NoiseImperfections& known,
                      std::vector<NoiseCause>& all) {
  const auto [windows, tick_rad] = wheel_windows(obs, model);
  if (windows.size() < kFewestWheelWindows) return;
  WheelParameters start;
  start << 2.0 * std::log(model.noise.distance_per_sqrt_m),
      2.0 * std::log(model.noise.heading_per_sqrt_m), 2.0 * std::log(model.noise.wheel_angle_rad),
      known.variance_by_speed, known.variance_by_turn, kNoOutliers;
  const WheelParameters null = fitted_wheels(windows, start, always_free(start));
  // What scatters so little was computed; what rounds readings by more than they scatter is no
  // noise and changes with speed like one.
  const double reading = std::exp(0.5 * (null[kReadingNoise] + usual_growth(windows, null)));
  if (reading < kFinestReading_rad || tick_rad > reading) return;
  const WheelNoise told = noise_of_wheels(windows, start, known.outliers);
  for (const NoiseCause& c : {told.outliers, told.slopes.by_turn, told.slopes.by_speed})
    all.push_back(c);
}

}  // namespace roadbook
