#pragma once

#include <span>
#include <vector>

#include "speedmap/property_map/normal_gamma.hpp"

namespace roadbook {

// Batch refresh of the classes against "lock in". With one update at a time, a class that starts
// wrong can lose its data to another class for ever, because each measurement is judged by classes
// that earlier measurements have changed. The refresh uses all stored measurements at once:
// variational Bayes, started from the class weights of the camera, which do not depend on the
// property.

struct ClassRefreshOptions {
  int sweeps = 15;
  /// Exponent of the weights in the first sweep, so that only measurements with a clear label start
  /// a class. An exponent of 1 contaminates classes that were not visited yet.
  double start_sharpness = 4.0;
  double outlier_weight = 0.0;
  double outlier_density = 0.0;  ///< 1 / width of the plausible range

  /// Throws InvalidOption.
  void check() const;
};

/// Returns the normal-gammas of the K classes, estimated from `prior` and all of `values`.
/// `class_weights`: values x K, row by row, each row sums to 1. `sigmas`: the sensor's standard
/// deviation of each value; empty: all 0.
///
/// O(sweeps x values x K); deterministic. Throws InvalidOption.
[[nodiscard]] std::vector<NormalGamma> refresh_classes(std::span<const double> values,
                                                       std::span<const double> class_weights,
                                                       std::span<const NormalGamma> prior,
                                                       const ClassRefreshOptions& options = {},
                                                       std::span<const double> sigmas = {});

}  // namespace roadbook
