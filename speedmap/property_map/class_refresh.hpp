#pragma once

#include <span>
#include <vector>

#include "speedmap/property_map/normal_gamma.hpp"

namespace roadbook {

// One update at a time, a class that starts wrong can lose its data to another class for good
// ("lock in"): every measurement is judged by classes that earlier ones have bent. The remedy looks
// at all measurements at once: variational Bayes on the log of what was measured, started from the
// class weights that the camera gives, which do not depend on the property.

struct ClassRefreshOptions {
  int sweeps = 15;
  /// Weights are raised to this power for the first sweep, so that only measurements whose class is
  /// clear from the labels start a class; plain weights (1) contaminate classes not yet visited.
  double start_sharpness = 4.0;
  double outlier_weight = 0.0;
  double outlier_density = 0.0;  ///< 1 / width of the plausible range

  /// Throws InvalidOption.
  void check() const;
};

/// Normal-gammas of the classes from `prior` and all of `values`; `class_weights` is values x K,
/// row by row, each row summing to 1. `sigmas`: the sensor's standard deviation of each value;
/// empty: 0 of all.
///
/// O(sweeps x values x K); deterministic. Throws InvalidOption.
[[nodiscard]] std::vector<NormalGamma> refresh_classes(std::span<const double> values,
                                                       std::span<const double> class_weights,
                                                       std::span<const NormalGamma> prior,
                                                       const ClassRefreshOptions& options = {},
                                                       std::span<const double> sigmas = {});

}  // namespace roadbook
