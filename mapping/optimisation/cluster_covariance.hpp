#pragma once

#include <cstdint>
#include <vector>

#include "mapping/optimisation/cluster_options.hpp"
#include "mapping/optimisation/covariance.hpp"

namespace roadbook {

// Covariances that count the common errors of residuals: the cluster-robust "sandwich"
//   C = H^-1 M H^-1,   M = sum over clusters of g g^T,
// where g is the sum of the scores (J^T r) of a cluster (Liang and Zeger 1986). Within a cluster
// any correlation is allowed. M adds what is common to
// - the views of one landmark: its corner lies beside the point by an error that changes slowly;
// - one camera at one place (cell of `cell_m`, quarter of the heading) on all visits, and the
//   wheels there;
// - nothing: independent noise of the size that all residuals have, and the stated noise of motions
//   and scales. This keeps poses honest that few landmarks hold.
// Scores of a landmark grow by 1 / (1 - leverage), as leaving it out would (CR3 of Bell and
// McCaffrey 2002). With few effective clusters the 95 % region of a normal distribution is too
// small: C grows by Hotelling's factor for their number.
//
// M is not formed: each of `cases` draws a sign for every cluster, and C is the mean of x x^T over
// x = H^-1 b (wild bootstrap in one linear step). Deterministic.

struct ClusterCovariance {
  bool usable = false;
  std::vector<Matrix6d> poses;       ///< relative to the first pose of its piece; NaN: unknown
  std::vector<double> scale_sigmas;  ///< NaN: unknown
  double effective_clusters = 0.0;   ///< median over the sampled poses; 0: not known
  double chi2 = 0.0;                 ///< of a robust residual, per degree of freedom
  std::string message;
};

/// Covariances at the state of `problem` (as bundle_adjust left it) with the observations of
/// `inlier` (all, if empty). `piece` of each pose: the first pose of each piece is its gauge, with
/// covariance zero. Poses that no terms tie to that pose are unknown. The same bytes on any number
/// of threads.
[[nodiscard]] ClusterCovariance cluster_covariance(const BundleProblem& problem,
                                                   const std::vector<std::uint8_t>& inlier,
                                                   const std::vector<int>& piece,
                                                   const BundleOptions& options,
                                                   const ClusterOptions& clusters = {});

}  // namespace roadbook
