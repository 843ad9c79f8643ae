#include "diagnosis/numerics/smoothed_rate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

struct Step {
  Eigen::Vector2d predicted, filtered;
  Eigen::Matrix2d P_predicted, P_filtered, F;
};

// Filter with walk `q` of the derivative per second, in units of the readings' common variance.
// Returns the log likelihood with that variance at its own best, but for constants.
double filter(const std::vector<RateReading>& readings, double q, std::vector<Step>* steps) {
  Eigen::Vector2d x(readings.front().rate, 0.0);
  // The derivative is unknown; the rate is unknown until the first reading.
  Eigen::Matrix2d P = Eigen::Vector2d(1e6 * readings.front().variance, 1e6 * q).asDiagonal();
  double squares = 0.0;
  double log_variance = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
    if (i > 0) {
      const double dt = 1e-9 * static_cast<double>(readings[i].t_ns - readings[i - 1].t_ns);
      F(0, 1) = dt;
      Eigen::Matrix2d Q;
      Q << dt * dt * dt / 3.0, 0.5 * dt * dt, 0.5 * dt * dt, dt;
      x = F * x;
      P = F * P * F.transpose() + q * Q;
    }
    if (steps != nullptr) (*steps)[i] = {x, x, P, P, F};
    const double S = P(0, 0) + readings[i].variance;
    const double off = readings[i].rate - x[0];
    const Eigen::Vector2d K = P.col(0) / S;
    x += K * off;
    P -= K * P.row(0).eval();
    P = 0.5 * (P + P.transpose()).eval();
    squares += off * off / S;
    log_variance += std::log(S);
    if (steps != nullptr) {
      (*steps)[i].filtered = x;
      (*steps)[i].P_filtered = P;
    }
  }
  const auto n = static_cast<double>(readings.size());
  return -0.5 * n * std::log(squares / n + 1e-300) - 0.5 * log_variance;
}

// Walk of the derivative that makes the readings most likely, by factors of 2.
double likely_walk(const std::vector<RateReading>& readings) {
  constexpr int kLowest = -4;
  constexpr int kHighest = 30;
  double best = -1e300;
  double walk = 1.0;
  for (int power = kLowest; power <= kHighest; ++power) {
    const double q = std::ldexp(1.0, power);
    if (const double l = filter(readings, q, nullptr); l > best) {
      best = l;
      walk = q;
    }
  }
  return walk;
}

}  // namespace

SmoothedRate::SmoothedRate(const std::vector<RateReading>& readings) {
  std::vector<RateReading> used;
  for (const RateReading& r : readings)
    if (used.empty() || r.t_ns > used.back().t_ns) used.push_back(r);
  ROADBOOK_ASSERT(!used.empty());
  std::vector<Step> steps(used.size());
  filter(used, likely_walk(used), &steps);
  t_ns_.resize(used.size());
  state_.resize(used.size());
  for (std::size_t i = used.size(); i-- > 0;) {
    t_ns_[i] = used[i].t_ns;
    state_[i] = steps[i].filtered;
    if (i + 1 == used.size()) continue;
    const Eigen::Matrix2d G =
        steps[i].P_filtered * steps[i + 1].F.transpose() * steps[i + 1].P_predicted.inverse();
    state_[i] += G * (state_[i + 1] - steps[i + 1].predicted);
  }
}

Eigen::Vector2d SmoothedRate::at(std::int64_t t_ns) const {
  const auto after = std::upper_bound(t_ns_.begin(), t_ns_.end(), t_ns);
  if (after == t_ns_.begin()) return state_.front();
  if (after == t_ns_.end()) return state_.back();
  const auto b = static_cast<std::size_t>(after - t_ns_.begin());
  const double w =
      static_cast<double>(t_ns - t_ns_[b - 1]) / static_cast<double>(t_ns_[b] - t_ns_[b - 1]);
  return (1.0 - w) * state_[b - 1] + w * state_[b];
}

}  // namespace roadbook
