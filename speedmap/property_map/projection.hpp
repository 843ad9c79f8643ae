#pragma once

#include <optional>
#include <span>

#include "speedmap/property_map/normal_gamma.hpp"

namespace roadbook {

// Bayesian moment matching [SPM, lemma 4]. The posterior after one measurement is a mixture. It is
// projected to the family of the prior by matching some of its moments. docs/results/friction.md
// compares the choices of moments.

enum class NormalGammaProjection {
  kPredictive,  ///< E[m], Var m, E[tau], E[1/tau]: always proper; recommended
  kNatural,     ///< E[tau], E[tau^2], E[m tau], E[m^2 tau]: alpha can fall below 1
  kKl,          ///< E[tau], E[log tau], E[m tau], E[m^2 tau]: nearest in KL; alpha can fall below 1
  kPrinted,     ///< (13a-d) as printed: lambda can fall below 0; for comparison only
};

enum class DirichletProjection {
  kTrace,       ///< exact means and sum of variances
  kFractional,  ///< a + rho: cheaper, a little over-confident
  kPrinted,     ///< (13e) as printed: does not keep the mean
};

/// Projects (1 - q) prior + q conjugate_update(prior, y), 0 <= q <= 1, to a normal-gamma. Empty if
/// the result is not proper; with kPredictive it always is.
[[nodiscard]] std::optional<NormalGamma> project_mixture(const NormalGamma& prior,
                                                         double y,
                                                         double q,
                                                         NormalGammaProjection projection);

/// The result of `project_mixture` without its check, proper or not.
[[nodiscard]] NormalGamma project_mixture_unguarded(const NormalGamma& prior,
                                                    double y,
                                                    double q,
                                                    NormalGammaProjection projection);

/// Projects (1 - r) Dir(a) + sum_j rho_j Dir(a + e_j), r = sum_j rho_j <= 1, to a Dirichlet, in
/// place in `a`. All rho >= 0. Cost O(K).
void project_dirichlet(std::span<double> a,
                       std::span<const double> rho,
                       DirichletProjection projection);

}  // namespace roadbook
