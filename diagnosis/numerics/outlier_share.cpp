#include "diagnosis/numerics/outlier_share.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace roadbook {
namespace {

constexpr double kOutlierVariance = 100.0;  // of an outlier's variance
constexpr std::size_t kMostOutliers = 7;    // outliers in a look, one fewer
constexpr std::size_t kGrid = 160;          // of the logarithm of a square
constexpr double kFirst = -12.0;            // of that grid
constexpr double kLast = 14.0;
constexpr double kGridStep = (kLast - kFirst) / static_cast<double>(kGrid - 1);

double chi_squared_density(double x, double freedom) {
  const double half = 0.5 * freedom;
  return std::exp((half - 1.0) * std::log(0.5 * x) - 0.5 * x - std::lgamma(half)) * 0.5;
}

// Of a sum of two squares: `normal` degrees of freedom, and `wide` of them `factor` times as large.
double sum_density(double square, double normal, double wide, double factor) {
  if (wide <= 0.0) return chi_squared_density(square, normal);
  if (normal <= 0.0) return chi_squared_density(square / factor, wide) / factor;
  // The normal part beyond its tail adds nothing; a sine takes the poles at both ends.
  const double most = std::min(square, normal + 12.0 * std::sqrt(2.0 * normal) + 25.0);
  constexpr int kPoints = 48;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 0.5 * std::numbers::pi * (i + 0.5) / kPoints;
    const double part = most * std::sin(angle) * std::sin(angle);
    sum += chi_squared_density(part, normal) * chi_squared_density((square - part) / factor, wide) /
           factor * 2.0 * most * std::sin(angle) * std::cos(angle);
  }
  return sum * 0.5 * std::numbers::pi / kPoints;
}

// Log density of a group's square with this number of outliers, on a grid.
class Densities {
 public:
  explicit Densities(const LookShape& shape) {
    for (std::size_t m = 0; m < kMostOutliers; ++m) {
      const double wide = std::min(static_cast<double>(m), shape.freedom);
      for (std::size_t i = 0; i < kGrid; ++i) {
        const double x = kFirst + kGridStep * static_cast<double>(i);
        double density = 0.0;
        for (const double leverage : shape.leverages)
          density += sum_density(std::exp(x), shape.freedom - wide, wide,
                                 1.0 + (kOutlierVariance - 1.0) * leverage) /
                     static_cast<double>(shape.leverages.size());
        log_[m][i] = std::log(std::max(density, 1e-300)) + x;
      }
    }
  }
  [[nodiscard]] double at(std::size_t m, double log_square) const {
    const double u = std::clamp((log_square - kFirst) / kGridStep, 0.0, kGrid - 1.001);
    const auto i = static_cast<std::size_t>(u);
    const double f = u - static_cast<double>(i);
    return std::exp((1.0 - f) * log_[m][i] + f * log_[m][i + 1]);
  }

 private:
  std::array<std::array<double, kGrid>, kMostOutliers> log_{};
};

// Groups of one kind: their scale at a given share.
class KindFit {
 public:
  explicit KindFit(const LooksAlike& looks) : shape_(looks.shape), densities_(looks.shape) {
    for (const double s : looks.squares) logs_.push_back(std::log(std::max(s, 1e-300)));
    level_ = first_level();
  }

  /// Expected outliers; the scale takes a step afterwards.
  double outliers_and_step(double share) {
    double outliers = 0.0;
    (void)likelihood(share, level_, &outliers);
    level_ += std::clamp(newton_step(share), -0.5, 0.5);
    return outliers;
  }

  [[nodiscard]] double readings() const {
    return static_cast<double>(logs_.size()) * shape_.readings;
  }

  /// Of the share, by the curvature of the likelihood in share and scale.
  [[nodiscard]] double information(double share) const {
    const double p = 0.2 * share;
    const double l = 0.02;
    const auto at = [&](int i, int j) { return likelihood(share + i * p, level_ + j * l); };
    const double here = at(0, 0);
    const double by_share = -(at(1, 0) - 2.0 * here + at(-1, 0)) / (p * p);
    const double by_level = -(at(0, 1) - 2.0 * here + at(0, -1)) / (l * l);
    const double both = -(at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4.0 * p * l);
    return by_share - both * both / std::max(by_level, 1e-9);
  }

 private:
  // A low quantile knows little of outliers (Wilson and Hilferty's approximation of its square).
  [[nodiscard]] double first_level() const {
    std::vector<double> sorted = logs_;
    const auto low = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 10);
    std::nth_element(sorted.begin(), low, sorted.end());
    const double nine = 2.0 / (9.0 * shape_.freedom);
    const double root = std::max(0.1, 1.0 - nine - 1.2816 * std::sqrt(nine));
    return *low - std::log(shape_.freedom * root * root * root);
  }

  [[nodiscard]] std::array<double, kMostOutliers> chances(double share) const {
    std::array<double, kMostOutliers> of{};
    double sum = 0.0;
    for (std::size_t m = 0; m < kMostOutliers; ++m) {
      const auto k = static_cast<double>(m);
      if (k > shape_.readings) break;
      of[m] = std::exp(std::lgamma(shape_.readings + 1.0) - std::lgamma(k + 1.0) -
                       std::lgamma(shape_.readings - k + 1.0) + k * std::log(share) +
                       (shape_.readings - k) * std::log1p(-share));
      sum += of[m];
    }
    for (double& c : of) c /= sum;
    return of;
  }

  [[nodiscard]] double likelihood(double share, double level, double* outliers = nullptr) const {
    const std::array<double, kMostOutliers> chance = chances(share);
    double sum = 0.0;
    for (const double x : logs_) {
      double density = 0.0;
      double expected = 0.0;
      for (std::size_t m = 0; m < kMostOutliers; ++m) {
        const double part = chance[m] * densities_.at(m, x - level);
        density += part;
        expected += static_cast<double>(m) * part;
      }
      sum += std::log(std::max(density, 1e-300));
      if (outliers != nullptr) *outliers += expected / std::max(density, 1e-300);
    }
    return sum;
  }

  [[nodiscard]] double newton_step(double share) const {
    constexpr double kSmall = 0.02;
    const double below = likelihood(share, level_ - kSmall);
    const double here = likelihood(share, level_);
    const double above = likelihood(share, level_ + kSmall);
    const double bend = (above - 2.0 * here + below) / (kSmall * kSmall);
    return bend < 0.0 ? -0.5 * (above - below) / kSmall / bend : 0.0;
  }

  LookShape shape_;
  Densities densities_;
  std::vector<double> logs_;
  double level_ = 0.0;
};

}  // namespace

OutlierShare fit_outlier_share(const std::vector<LooksAlike>& kinds) {
  constexpr int kRounds = 40;
  constexpr int kFewestRounds = 5;  // in which the scales settle
  constexpr double kClose = 1e-4;
  constexpr double kLeast = 1e-6;
  constexpr double kMost = 0.9;
  std::vector<KindFit> fits;
  double readings = 0.0;
  for (const LooksAlike& looks : kinds) {
    if (looks.squares.empty()) continue;
    fits.emplace_back(looks);
    readings += fits.back().readings();
  }
  const auto next = [&](double share) {
    double outliers = 0.0;
    for (KindFit& fit : fits) outliers += fit.outliers_and_step(share);
    return std::clamp(outliers / readings, kLeast, kMost);
  };
  // Where looks hardly tell, expectation and maximization creep: Aitken's rule, of the logarithm,
  // says where two of their steps lead.
  double share = 0.02;
  for (int i = 0; i < kRounds; ++i) {
    const double before = share;
    const double first = next(before);
    const double second = next(first);
    const double step = std::log(first / before);
    const double bend = std::log(second / first) - step;
    const bool slows = std::abs(bend) > 1e-12 && -step / bend > 1.0;
    const double leap = slows ? std::clamp(-step * step / bend, -1.0, 1.0) : 0.0;
    share = std::clamp(slows ? before * std::exp(leap) : second, kLeast, kMost);
    if (i > kFewestRounds && std::abs(std::log(share / before)) < kClose) break;
  }
  double information = 0.0;
  for (const KindFit& fit : fits) information += std::max(0.0, fit.information(share));
  return {share, information > 0.0 ? 1.0 / std::sqrt(information) : share};
}

}  // namespace roadbook
