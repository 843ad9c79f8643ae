#include "speedmap/presence/presence_map.hpp"

#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace roadbook {

PresenceMap::PresenceMap(PresenceGraph graph)
    : graph_(std::move(graph)), error_bound_(std::numeric_limits<double>::infinity()) {
  prepare();
  x_.resize(static_cast<Eigen::Index>(size()));
  for (std::size_t i = 0; i < size(); ++i) x_[static_cast<Eigen::Index>(i)] = graph_.nodes[i].prior;
}

PresenceMap::PresenceMap(PresenceGraph graph, Eigen::VectorXd earlier)
    : graph_(std::move(graph)), x_(std::move(earlier)), error_bound_(0.0) {
  prepare();
  if (x_.size() != static_cast<Eigen::Index>(size()) || !x_.allFinite())
    throw InvalidOption("earlier", std::to_string(x_.size()) + " values",
                        "a finite one for each of " + std::to_string(size()) + " nodes");
}

// Neighbours by node, and the normal equations of the priors alone.
void PresenceMap::prepare() {
  graph_.check();
  const std::size_t n = size();
  begin_.assign(n + 1, 0);
  for (const PresenceEdge& edge : graph_.edges) {
    ++begin_[static_cast<std::size_t>(edge.a) + 1];
    ++begin_[static_cast<std::size_t>(edge.b) + 1];
  }
  for (std::size_t i = 0; i < n; ++i) begin_[i + 1] += begin_[i];
  neighbours_.resize(2 * graph_.edges.size());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (const PresenceEdge& edge : graph_.edges) {
    neighbours_[next[static_cast<std::size_t>(edge.a)]++] = {edge.b, edge.weight};
    neighbours_[next[static_cast<std::size_t>(edge.b)]++] = {edge.a, edge.weight};
  }
  excess_.resize(static_cast<Eigen::Index>(n));
  b_.resize(static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    excess_[row] = graph_.nodes[i].weight;
    b_[row] = graph_.nodes[i].weight * graph_.nodes[i].prior;
  }
}

std::span<const PresenceMap::Neighbour> PresenceMap::neighbours(int node) const {
  const auto i = static_cast<std::size_t>(node);
  return {neighbours_.data() + begin_[i], begin_[i + 1] - begin_[i]};
}

void PresenceMap::add(std::span<const PresenceObservation> observations) {
  const auto refuse = [](const char* field, const std::string& got, const std::string& want) {
    throw BadInput(Problem{Severity::kError, "", 0, field, got, want});
  };
  for (const PresenceObservation& z : observations) {
    if (z.node < 0 || static_cast<std::size_t>(z.node) >= size())
      refuse("observation.node", std::to_string(z.node), "a place of the map");
    if (!(z.value >= 0.0 && z.value <= 1.0))
      refuse("observation.value", std::to_string(z.value), "0 to 1");
    if (!(std::isfinite(z.weight) && z.weight >= 0.0))
      refuse("observation.weight", std::to_string(z.weight), "0 or more");
  }
  for (const PresenceObservation& z : observations) {
    excess_[z.node] += z.weight;
    b_[z.node] += z.weight * z.value;
    touched_.push_back(z.node);
  }
}

Eigen::SparseMatrix<double> PresenceMap::matrix() const {
  const auto n = static_cast<Eigen::Index>(size());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(size() + graph_.edges.size());
  for (int i = 0; i < n; ++i) {
    double diagonal = excess_[i];
    for (const Neighbour& other : neighbours(i)) {
      diagonal += other.weight;
      if (other.node < i) entries.emplace_back(i, other.node, -other.weight);
    }
    entries.emplace_back(i, i, diagonal);
  }
  Eigen::SparseMatrix<double> A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

double PresenceMap::energy(const Eigen::VectorXd& x) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double mean = b_[i] / excess_[i];
    sum += 0.5 * excess_[i] * (x[i] - mean) * (x[i] - mean);
  }
  for (const PresenceEdge& edge : graph_.edges)
    sum += 0.5 * edge.weight * (x[edge.a] - x[edge.b]) * (x[edge.a] - x[edge.b]);
  return sum;
}

}  // namespace roadbook
