#pragma once

#include <vector>

#include "mapping/optimisation/cluster_draws.hpp"

namespace roadbook {

/// Number of equal clusters that would leave the six parameters of a pose as uncertain in shape as
/// the actual ones: (sum q)^2 / sum q^2 with q = |L^-1 a|^2, a = H^-1 g of one cluster, and L L^T
/// the covariance of the pose (Satterthwaite; Bell and McCaffrey 2002). Median over the sampled
/// poses; 0 without any. `system`: just solved with lambda 0.
[[nodiscard]] double effective_clusters(const ClusterData& data,
                                        const BundleSystem& system,
                                        const std::vector<Matrix6d>& covariances);

}  // namespace roadbook
