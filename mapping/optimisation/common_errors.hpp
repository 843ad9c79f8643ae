#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/optimisation/cluster_draws.hpp"

namespace roadbook {

// An error that all pixels of a camera have in common, such as a wrong focal length, moves the
// poses but hardly shows as a cluster: the poses absorb most of it. A suspected one therefore
// enters the covariance as the move that it causes. With e the shift of the predicted pixels, to
// first order
//   dx = H^-1 J^T e,   C += s^2 dx dx^T.
// The suspect may be found with poses that have already absorbed a part of it. So s is the size
// that explains the residuals best while poses and points are free (score test, Rao 1948),
//   s = e~^T r / (e~^T e~),   e~ = e - J H^-1 J^T e,
// but at least 1, the stated size. An error that nothing else speaks for counts if s is beyond six
// of its standard deviations, with the landmarks' parts of e~^T r as independent. One that is known
// counts as stated.

/// How far the poses and the free scales move because of a common error.
struct CommonMove {
  Eigen::VectorXd poses;   ///< six rows for each pose variable
  Eigen::VectorXd scales;  ///< of each free scale
  double size = 1.0;       ///< s; 0: the error does not count
};

/// One move for each error, times its size. `system`: just solved with lambda 0. Costs one
/// right-hand side an error.
[[nodiscard]] std::vector<CommonMove> moves_of(const ClusterData& data,
                                               const BundleSystem& system,
                                               const std::vector<CommonError>& errors);

}  // namespace roadbook
