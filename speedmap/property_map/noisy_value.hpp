#pragma once

#include <algorithm>

#include "speedmap/property_map/normal_gamma.hpp"

namespace roadbook {

// Measurements with a known noise of the sensor in addition to the variance within their class. The
// sensor sees a class of variance Q as one of variance Q + sigma^2. With k = Q / (Q + sigma^2), a
// measurement counts k for the mean and k^2 for the variance (Fisher information).

/// The class as the sensor sees it: the same mean with the same uncertainty, a larger variance.
[[nodiscard]] inline NormalGamma as_sensed(const NormalGamma& ng, double sigma) {
  if (sigma == 0.0) return ng;
  const double grow = 1.0 + sigma * sigma / ng.expected_variance();
  return {ng.mu, ng.lambda * grow, ng.alpha, ng.beta * grow};
}

/// Belief about the ground after an update changed as_sensed(before) to `sensed`. For a well known
/// variance this is the Kalman update of the mean. Q falls by at most half in one update, so that
/// it stays above 0 for any stated `sigma`.
[[nodiscard]] inline NormalGamma of_the_ground(const NormalGamma& before,
                                               const NormalGamma& sensed,
                                               double sigma) {
  const double Q = before.expected_variance();
  const double k = Q / (Q + sigma * sigma);
  const double learned = sensed.alpha - before.alpha;
  NormalGamma after;
  after.mu = sensed.mu;
  after.alpha = std::max(before.alpha + k * k * learned, 1.0 + 0.5 * (before.alpha - 1.0));
  const double change = sensed.expected_variance() - Q / k;
  const double share = k * k * (sensed.alpha - 1.0) / (after.alpha - 1.0);
  const double Q_after = std::max(Q + share * change, 0.5 * Q);
  after.lambda = Q_after / sensed.mean_variance();
  after.beta = Q_after * (after.alpha - 1.0);
  return after;
}

}  // namespace roadbook
