#include "diagnosis/streams/variance_samples.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "base/median.hpp"
#include "diagnosis/inference/score_table.hpp"

namespace roadbook {
namespace {

constexpr double kChance = 1e-5;  // p-value below which a sample counts as extreme
constexpr double kFewestOfSlope = 50.0;
// Least variance of a usable covariate.
constexpr double kLeastVariance = 1e-4;

using Values = std::vector<double>;

double dot(const Values& a, const Values& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void take_mean(Values& values) {
  double mean = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (double& v : values) v -= mean;
}

// Subtracts the projection on `other`.
void take_off(const Values& other, Values& values) {
  const double square = dot(other, other);
  const double slope = square > 0.0 ? dot(other, values) / square : 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= slope * other[i];
}

// Factor on the standard error of a slope if neighbouring residuals follow a first-order
// autoregressive process.
double widened_by_neighbours(const Values& residual) {
  double lagged = 0.0;
  for (std::size_t i = 1; i < residual.size(); ++i) lagged += residual[i] * residual[i - 1];
  const double r = std::clamp(lagged / std::max(dot(residual, residual), 1e-300), 0.0, 0.95);
  return std::sqrt((1.0 + r) / (1.0 - r));
}

// Slope of y on x with `other` in the model (empty: alone). All are centred.
NoiseCause slope_beside(
    const std::string& effect, const char* unit, Values x, Values y, const Values& other) {
  if (!other.empty()) {
    take_off(other, x);
    take_off(other, y);
  }
  const auto n = static_cast<double>(x.size());
  const double xx = dot(x, x);
  if (n < kFewestOfSlope || xx / n < kLeastVariance)
    return noise_cause(effect, unit, 0.0, 0.0, 0.0);
  const double slope = dot(x, y) / xx;
  take_off(x, y);
  const double sigma = std::sqrt(dot(y, y) / (n - 2.0) / xx) * widened_by_neighbours(y);
  return noise_cause(effect, unit, slope, sigma, slope / sigma);
}

double scale_of_looks(const std::vector<VarianceSample>& looks) {
  Values scaled;
  for (const VarianceSample& l : looks) scaled.push_back(l.square / median_share(l.freedom));
  return scaled.empty() ? 1.0 : std::max(median(scaled), 1e-300);
}

// For each sample whether its p-value is below `chance`.
std::vector<bool> beyond(const std::vector<VarianceSample>& looks, double scale, double chance) {
  std::vector<bool> far;
  for (const VarianceSample& l : looks)
    far.push_back(chi_squared_tail(l.square / scale * l.freedom,
                                   std::max(1, static_cast<int>(std::ceil(l.freedom - 1e-9)))) <
                  chance);
  return far;
}

OutlierShare fitted_share(const std::vector<VarianceSample>& looks,
                          const std::vector<LookShape>& shapes) {
  std::vector<LooksAlike> kinds;
  for (const LookShape& shape : shapes) kinds.push_back({shape, {}});
  for (const VarianceSample& l : looks) kinds[l.kind].squares.push_back(l.square * l.freedom);
  return fit_outlier_share(kinds);
}

// Share of outliers from samples of one reading: the number of extreme samples over the probability
// that an outlier is extreme. A fit would count every heavy tail as outliers.
OutlierShare share_of_single(double far, std::size_t looks) {
  const double bound = quantile(complement(boost::math::chi_squared(1), kChance));
  const double seen = chi_squared_tail(bound / 100.0, 1) * static_cast<double>(looks);
  return {far / seen, std::sqrt(std::max(far, 1.0)) / seen};
}

}  // namespace

double median_share(double freedom) {
  const double a = 1.0 - 2.0 / (9.0 * freedom);
  return a * a * a;
}

NoiseCause noise_cause(
    const std::string& effect, const char* unit, double size, double sigma, double z) {
  return {effect, unit, size, sigma, z, std::erfc(std::abs(z) / std::sqrt(2.0))};
}

NoiseCause with_sigma(const NoiseCause& cause, double sigma, double known) {
  if (known > 0.0)
    return noise_cause(cause.effect, cause.unit.c_str(), cause.size, sigma, cause.size / sigma);
  NoiseCause other = cause;  // its significance is independent of the standard error
  other.sigma = sigma;
  return other;
}

VarianceSample VarianceSlopes::without(VarianceSample look) const {
  look.square *= std::exp(-speed * look.speed - turn * look.turn);
  return look;
}

VarianceSlopes variance_slopes(const std::string& stream,
                               const std::vector<VarianceSample>& looks,
                               const NoiseImperfections& known) {
  VarianceSlopes slopes;
  slopes.speed = known.variance_by_speed;
  slopes.turn = known.variance_by_turn;
  Values speed, turn, y;
  for (const VarianceSample& l : looks) {
    speed.push_back(l.speed);
    turn.push_back(l.turn);
    y.push_back(std::log(slopes.without(l).square + 1e-300));
  }
  for (Values* values : {&speed, &turn, &y}) take_mean(*values);
  const auto by_speed = [&](const Values& other) {
    return slope_beside(stream + ".variance(speed)", "s/m", speed, y, other);
  };
  const auto by_turn = [&](const Values& other) {
    return slope_beside(stream + ".variance(turn)", "s/rad", turn, y, other);
  };
  slopes.by_speed = by_speed({});
  slopes.by_turn = by_turn({});
  // Speed and turn rate are correlated: first the weaker with the stronger in the model, then the
  // stronger with the weaker.
  if (std::abs(slopes.by_speed.z) >= std::abs(slopes.by_turn.z)) {
    if (is_sure(slopes.by_speed)) slopes.by_turn = by_turn(speed);
    if (is_sure(slopes.by_turn)) slopes.by_speed = by_speed(turn);
  } else {
    if (is_sure(slopes.by_turn)) slopes.by_speed = by_speed(turn);
    if (is_sure(slopes.by_speed)) slopes.by_turn = by_turn(speed);
  }
  if (is_sure(slopes.by_speed)) slopes.speed += slopes.by_speed.size;
  if (is_sure(slopes.by_turn)) slopes.turn += slopes.by_turn.size;
  return slopes;
}

std::vector<bool> may_hold_outliers(const std::vector<VarianceSample>& looks) {
  constexpr double kQuartile = -0.6745;  // lower quartile of the normal distribution
  Values scaled;
  for (const VarianceSample& l : looks) {
    const double nine = 2.0 / (9.0 * l.freedom);
    scaled.push_back(l.square /
                     std::pow(std::max(0.1, 1.0 - nine + kQuartile * std::sqrt(nine)), 3));
  }
  const auto quarter = scaled.begin() + static_cast<std::ptrdiff_t>(scaled.size() / 4);
  std::nth_element(scaled.begin(), quarter, scaled.end());
  return beyond(looks, std::max(*quarter, 1e-300), 0.01);
}

NoiseCause outliers(const std::string& stream,
                    const std::vector<VarianceSample>& looks,
                    const std::vector<LookShape>& shapes,
                    double known) {
  const std::string effect = stream + ".outliers";
  const std::vector<bool> far = beyond(looks, scale_of_looks(looks), kChance);
  const auto count = static_cast<double>(std::count(far.begin(), far.end(), true));
  const double expected = static_cast<double>(looks.size()) * kChance;
  // Fewer than three extreme samples are no evidence.
  if (count < 3.0 && known <= 0.0) return noise_cause(effect, "1", 0.0, 0.0, 0.0);
  const OutlierShare fit = shapes.size() == 1 && shapes[0].readings == 1.0
                               ? share_of_single(count - expected, looks.size())
                               : fitted_share(looks, shapes);
  if (known > 0.0)
    return noise_cause(effect, "1", fit.share - known, fit.sigma, (fit.share - known) / fit.sigma);
  // Poisson tail probability, then an equivalent normal deviate.
  double tail = 1.0;
  double term = std::exp(-expected);
  for (double k = 0.0; k < count; k += 1.0) {
    tail -= term;
    term *= expected / (k + 1.0);
  }
  NoiseCause c = noise_cause(effect, "1", fit.share, fit.sigma, 0.0);
  c.p = std::max(tail, 1e-15);
  c.z = std::sqrt(2.0 * count * std::log(std::max(count / expected, 1.0)));
  return c;
}

}  // namespace roadbook
