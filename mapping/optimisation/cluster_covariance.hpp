#pragma once

#include <cstdint>
#include <vector>

#include "mapping/optimisation/cluster_options.hpp"
#include "mapping/optimisation/covariance.hpp"

namespace roadbook {

// Covariances that count the common errors of residuals: the cluster-robust "sandwich"
//   C = H^-1 M H^-1,   M = sum over clusters of g g^T,
// where g is the sum of the scores (J^T r) of a cluster (Liang and Zeger 1986). Within a cluster
// any correlation is allowed. Residuals belong to two kinds of clusters:
// - L, the views of one landmark: its corner lies beside the point by an error that changes slowly;
// - P, one camera at one place (cell of `cell_m`, quarter of the heading) on all visits, and the
//   wheels there.
// A sum of both would count what one landmark shows to one camera at one place twice, and so all
// independent noise. Multiway clustering takes the clusters of both kinds off again (Cameron,
// Gelbach and Miller 2011): M = M_L + M_P - M_LP. The difference C_P - C_LP is what landmarks have
// in common at a place. Where it is negative it is chance, and it counts as zero (their section
// 2.3). On simulated drives the larger of C_L and C_P alone held fewer of the true errors
// (MacKinnon, Nielsen and Webb 2021 discuss both).
//
// The stated noise of motions, scales and priors counts in C_L. Independent pixels of the size that
// all residuals have are a lower bound, for poses that few landmarks hold.
//
// Scores of a landmark grow by 1 / (1 - leverage), as leaving it out would (CR3 of Bell and
// McCaffrey 2002). With few effective clusters the 95 % region of a normal distribution is too
// small: C grows by Hotelling's factor for their number.
//
// Clusters cannot show an error that all pixels of a camera share, such as a wrong focal length.
// Suspected ones widen C by the move that they cause (common_errors.hpp).
//
// No M is formed: each of `cases` draws a sign for every cluster, and each C is the mean of x x^T
// over x = H^-1 b (wild bootstrap in one linear step). Deterministic.

struct ClusterCovariance {
  bool usable = false;
  std::vector<Matrix6d> poses;       ///< relative to the first pose of its piece; NaN: unknown
  std::vector<double> scale_sigmas;  ///< NaN: unknown
  double effective_clusters = 0.0;   ///< median over the sampled poses; 0: not known
  std::string message;
};

/// Covariances at the state of `problem` (as bundle_adjust left it) with the observations of
/// `inlier` (all, if empty). `piece` of each pose: the first pose of each piece is its gauge, with
/// covariance zero. Poses that no terms tie to that pose are unknown. `suspected`: errors that may
/// be in the pixels. During the call more poses of `problem` are fixed; in the end they are as
/// before. The same bytes on any number of threads.
[[nodiscard]] ClusterCovariance cluster_covariance(BundleProblem& problem,
                                                   const std::vector<std::uint8_t>& inlier,
                                                   const std::vector<int>& piece,
                                                   const BundleOptions& options,
                                                   const ClusterOptions& clusters = {},
                                                   const std::vector<CommonError>& suspected = {});

}  // namespace roadbook
