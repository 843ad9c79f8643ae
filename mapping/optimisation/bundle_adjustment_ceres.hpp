#pragma once

#include "base/progress.hpp"
#include "mapping/optimisation/bundle_adjustment_terms.hpp"

namespace roadbook {

/// Result of one minimisation with a fixed set of observations.
struct BundleMinimum {
  double initial_cost = 0.0;  ///< bundle_cost at the start
  double final_cost = 0.0;    ///< bundle_cost at the end
  int iterations = 0;         ///< linear solves
  bool converged = false;
};

/// Minimises `bundle_cost` by Ceres, starting from `state` and writing the minimum into it. Points
/// are eliminated (sparse Schur complement). Throws Interrupted.
BundleMinimum minimise_by_ceres(const BundleProblem& problem,
                                const BundleLayout& layout,
                                const BundleOptions& options,
                                BundleState& state,
                                const Progress& progress);

}  // namespace roadbook
