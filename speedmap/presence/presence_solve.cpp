#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "speedmap/presence/presence_map.hpp"

// The dynamic map for all places at once. Conjugate gradients need no matrix and no factor: a
// million places take an eighth of the time of a factor and less than half of its memory. The
// number of steps grows with the root of (largest diagonal / smallest excess), 60 with the default
// reach.

namespace roadbook {
namespace {

// Below that a factor is quicker, and exact to rounding.
constexpr std::size_t kFewPlaces = 4096;
constexpr int kMostSteps = 400;
constexpr double kLargestError = 1e-12;

}  // namespace

void PresenceMap::solve() {
  if (size() <= kFewPlaces || !solve_by_gradients()) solve_by_factor();
  touched_.clear();
  error_bound_ = 0.0;
}

void PresenceMap::solve_by_factor() {
  // Minimum degree: for a million places 0.6 s of ordering and 4.2 s of factor, where nested
  // dissection takes 4.7 s and 3.4 s.
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholesky;
  cholesky.cholmod().nmethods = 1;
  cholesky.cholmod().method[0].ordering = CHOLMOD_AMD;
  cholesky.compute(matrix());
  ROADBOOK_ASSERT(cholesky.info() == Eigen::Success);  // diagonally dominant by check()
  x_ = cholesky.solve(b_);
}

// Conjugate gradients (Saad 2003, algorithm 6.18) on the matrix scaled to a diagonal of ones. They
// start from the mean of each place's own information and not from an earlier solution, so that the
// result does not depend on what was solved before. Rows of the matrix sum to `excess`, so that
// |error| <= max |residual| / min excess. False: more steps are needed than are worth it.
//
// A step takes as long as memory takes to pass by: each edge is read once for both of its places,
// and all sums of a step are made in one pass.
bool PresenceMap::solve_by_gradients() {
  const std::size_t n = size();
  std::vector<double> root(n);  // of the diagonal
  for (std::size_t i = 0; i < n; ++i) {
    double diagonal = excess_[static_cast<Eigen::Index>(i)];
    for (const Neighbour& other : neighbours(static_cast<int>(i))) diagonal += other.weight;
    root[i] = std::sqrt(diagonal);
  }
  const ScaledEdges edges = scaled_edges(root);
  x_ = b_.cwiseQuotient(excess_);
  std::vector<double> scaled(n);  // x times root
  std::vector<double> rest(n);
  const auto compute_rest = [&] {
    double most = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      rest[i] = residual(static_cast<int>(i)) / root[i];
      most = std::max(most, std::abs(rest[i]));
    }
    return most;
  };
  for (std::size_t i = 0; i < n; ++i) scaled[i] = x_[static_cast<Eigen::Index>(i)] * root[i];
  // Rounding of a residual is about 4e-16 of the largest diagonal.
  const double largest = *std::max_element(root.begin(), root.end());
  const double goal =
      std::max(kLargestError * excess_.minCoeff(), 4e-16 * largest * largest) / largest;
  double most = compute_rest();
  double squared = std::inner_product(rest.begin(), rest.end(), rest.begin(), 0.0);
  std::vector<double> direction = rest;
  std::vector<double> product(n, 0.0);
  for (int step = 0; step < kMostSteps; ++step) {
    if (most <= goal) {
      // The updates of the residual carry rounding errors: it is computed again from the solution.
      for (std::size_t i = 0; i < n; ++i) x_[static_cast<Eigen::Index>(i)] = scaled[i] / root[i];
      if (compute_rest() <= 2.0 * goal) return true;
      direction = rest;
      squared = std::inner_product(rest.begin(), rest.end(), rest.begin(), 0.0);
    }
    double along = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double own = direction[i];
      double sum = product[i] + own;
      for (std::size_t k = edges.begin[i]; k < edges.begin[i + 1]; ++k) {
        const auto later = static_cast<std::size_t>(edges.later[k]);
        sum -= edges.weight[k] * direction[later];
        product[later] -= edges.weight[k] * own;
      }
      product[i] = sum;
      along += sum * own;
    }
    const double length = squared / along;
    double next = 0.0;
    most = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      scaled[i] += length * direction[i];
      rest[i] -= length * product[i];
      product[i] = 0.0;
      next += rest[i] * rest[i];
      most = std::max(most, std::abs(rest[i]));
    }
    const double turn = next / squared;
    for (std::size_t i = 0; i < n; ++i) direction[i] = rest[i] + turn * direction[i];
    squared = next;
  }
  return false;
}

PresenceMap::ScaledEdges PresenceMap::scaled_edges(const std::vector<double>& root) const {
  ScaledEdges edges;
  edges.begin.reserve(size() + 1);
  edges.later.reserve(graph_.edges.size());
  edges.weight.reserve(graph_.edges.size());
  edges.begin.push_back(0);
  for (std::size_t i = 0; i < size(); ++i) {
    for (const Neighbour& other : neighbours(static_cast<int>(i))) {
      const auto j = static_cast<std::size_t>(other.node);
      if (j < i) continue;
      edges.later.push_back(other.node);
      edges.weight.push_back(other.weight / (root[i] * root[j]));
    }
    edges.begin.push_back(edges.later.size());
  }
  return edges;
}

}  // namespace roadbook
