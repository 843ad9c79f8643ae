#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "speedmap/presence/presence_map.hpp"

// Local updates of the dynamic map. The effect of an observation fades over a few times the
// smoothing distance (like exp(-d / reach)), so a window is enough. The residual at the window's
// border decides its width: rows of the matrix sum to `excess`, so |error| <= max |residual| / min
// excess everywhere.

namespace roadbook {

double PresenceMap::residual(int node) const {
  double sum = b_[node] - excess_[node] * x_[node];
  for (const Neighbour& other : neighbours(node)) sum -= other.weight * (x_[node] - x_[other.node]);
  return sum;
}

// Ascending: all nodes that are at most `hops` edges from a touched one.
std::vector<int> PresenceMap::window(int hops) const {
  std::vector<int> nodes;
  std::vector<bool> in(size(), false);
  for (const int node : touched_)
    if (!in[static_cast<std::size_t>(node)]) {
      in[static_cast<std::size_t>(node)] = true;
      nodes.push_back(node);
    }
  std::size_t ring = 0;
  for (int hop = 0; hop < hops; ++hop) {
    const std::size_t end = nodes.size();
    for (; ring < end; ++ring)
      for (const Neighbour& other : neighbours(nodes[ring]))
        if (!in[static_cast<std::size_t>(other.node)]) {
          in[static_cast<std::size_t>(other.node)] = true;
          nodes.push_back(other.node);
        }
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

void PresenceMap::solve_window(const std::vector<int>& nodes) {
  const auto index_of = [&](int node) {
    const auto at = std::lower_bound(nodes.begin(), nodes.end(), node);
    return at != nodes.end() && *at == node ? static_cast<int>(at - nodes.begin()) : -1;
  };
  const auto n = static_cast<Eigen::Index>(nodes.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd b(n);
  for (int i = 0; i < n; ++i) {
    const int node = nodes[static_cast<std::size_t>(i)];
    double diagonal = excess_[node];
    b[i] = b_[node];
    for (const Neighbour& other : neighbours(node)) {
      diagonal += other.weight;
      const int j = index_of(other.node);
      if (j < 0) b[i] += other.weight * x_[other.node];
      if (j >= 0 && j < i) entries.emplace_back(i, j, -other.weight);
    }
    entries.emplace_back(i, i, diagonal);
  }
  Eigen::SparseMatrix<double> A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky(A);
  ROADBOOK_ASSERT(cholesky.info() == Eigen::Success);
  const Eigen::VectorXd x = cholesky.solve(b);
  for (int i = 0; i < n; ++i) x_[nodes[static_cast<std::size_t>(i)]] = x[i];
}

double PresenceMap::border_residual(const std::vector<int>& nodes) const {
  double worst = 0.0;
  for (const int node : nodes) {
    worst = std::max(worst, std::abs(residual(node)));
    for (const Neighbour& other : neighbours(node))
      worst = std::max(worst, std::abs(residual(other.node)));
  }
  return worst;
}

PresenceUpdate PresenceMap::update(double tolerance) {
  if (!(tolerance > 0.0)) throw InvalidOption("tolerance", std::to_string(tolerance), "above 0");
  if (touched_.empty() && std::isfinite(error_bound_)) return {0, error_bound_};
  const double dominance = excess_.minCoeff();
  for (int hops = 8; error_bound_ < tolerance; hops = hops * 3 / 2) {
    const std::vector<int> nodes = window(hops);
    if (2 * nodes.size() > size()) break;
    solve_window(nodes);
    const double bound = border_residual(nodes) / dominance;
    if (error_bound_ + bound <= tolerance) {
      error_bound_ += bound;
      touched_.clear();
      return {nodes.size(), error_bound_};
    }
  }
  solve();
  return {size(), 0.0};
}

PresenceUpdate PresenceMap::resume(double tolerance) {
  if (!(tolerance > 0.0)) throw InvalidOption("tolerance", std::to_string(tolerance), "above 0");
  // Residuals that are left alone cost a tenth of the tolerance at most.
  const double left_alone = 0.1 * tolerance;
  const double least = left_alone * excess_.minCoeff();
  touched_.clear();
  for (int node = 0; node < static_cast<int>(size()); ++node)
    if (std::abs(residual(node)) > least) touched_.push_back(node);
  error_bound_ = left_alone;
  return update(tolerance);
}

}  // namespace roadbook
