#pragma once

#include <span>
#include <vector>

#include "speedmap/property_map/normal_gamma.hpp"

namespace roadbook {

/// Exact posterior of one measurement y as a mixture [SPM, lemma 3, for any number of knots
/// L]: y came from class j of knot l with probability rho_lj ~ I_l u_j^l c_j, or from none.
struct PropertyMixture {
  std::vector<double> log_c;  ///< K: log marginal density of y under each class
  std::vector<double> rho;    ///< L x K; sums to `inlier`
  std::vector<double> q;      ///< K: sum over the knots
  double log_evidence = 0.0;  ///< log p(y), outliers included
  double inlier = 1.0;
};

struct MixtureOptions {
  bool literal_root = false;
  double outlier_weight = 0.0;
  double outlier_density = 0.0;  ///< 1 / width of the plausible range
};

/// Computes the posterior. `weights`: I_l of the L knots nearby. `shares`: their u^l, L x K. Works
/// with logarithms, so that no y causes under- or overflow. Reuse `result`: it keeps its memory.
void mixture_posterior(double y,
                       std::span<const double> weights,
                       std::span<const double> shares,
                       std::span<const NormalGamma> classes,
                       const MixtureOptions& options,
                       PropertyMixture& result);

}  // namespace roadbook
