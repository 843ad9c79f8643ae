#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "speedmap/presence/presence_graph.hpp"

namespace roadbook {

struct PresenceUpdate {
  std::size_t solved = 0;    ///< nodes solved for; all of them if a window would cost more
  double error_bound = 0.0;  ///< largest difference of a node from the solution of the whole graph
};

/// The dynamic map [metric-semantic maps, section V-C]: the x that minimises E(x) of a
/// PresenceGraph, by conjugate gradients, or by one sparse Cholesky factorisation where those would
/// need many steps.
///
/// The matrix is an M-matrix, so x stays between the smallest and the largest of priors and
/// observations. Deterministic: one thread. Const members may run concurrently.
class PresenceMap {
 public:
  /// Starts without observations, with x the priors: the first `solve`, `update` or `resume` solves
  /// for all nodes. Throws InvalidOption.
  explicit PresenceMap(PresenceGraph graph);
  /// Starts from an earlier solution (a value for each node), without solving. Call `add`, then
  /// `resume`.
  PresenceMap(PresenceGraph graph, Eigen::VectorXd earlier);

  /// Adds observations; call `solve` or `update` to compute x. Throws BadInput for a node that does
  /// not exist, a value outside 0 to 1 or a weight that is negative or not finite; the map is then
  /// unchanged.
  void add(std::span<const PresenceObservation> observations);

  /// Solves for all nodes: no node is wrong by more than 1e-12 and rounding.
  void solve();
  /// Solves in a window around the observations added since the last call, with the other nodes
  /// held fixed. Widens the window until the residual at its border proves that no node is wrong by
  /// more than `tolerance`. The bounds of successive updates add up; `solve` resets them to 0.
  PresenceUpdate update(double tolerance = 1e-6);

  /// Solves in a window around the nodes where the earlier solution has a residual, as `update`
  /// does.
  PresenceUpdate resume(double tolerance = 1e-6);

  [[nodiscard]] const Eigen::VectorXd& presence() const { return x_; }
  /// Marginal posterior variance of every node: the diagonal of the inverse, from its entries
  /// within the sparsity pattern of the factor (Takahashi 1973).
  [[nodiscard]] Eigen::VectorXd variances() const;

  [[nodiscard]] std::size_t size() const { return graph_.nodes.size(); }
  [[nodiscard]] const PresenceGraph& graph() const { return graph_; }
  /// E(x) without its constant: the terms that observations add to those of their weighted mean.
  [[nodiscard]] double energy(const Eigen::VectorXd& x) const;
  /// Lower triangle of the matrix of the normal equations, and their right-hand side.
  [[nodiscard]] Eigen::SparseMatrix<double> matrix() const;
  [[nodiscard]] const Eigen::VectorXd& right_hand_side() const { return b_; }

 private:
  struct Neighbour {
    int node;
    double weight;
  };
  /// The edges of each node to those after it, with weights for a diagonal of ones.
  struct ScaledEdges {
    std::vector<std::size_t> begin;
    std::vector<int> later;
    std::vector<double> weight;
  };
  void prepare();
  void solve_by_factor();
  [[nodiscard]] bool solve_by_gradients();
  [[nodiscard]] ScaledEdges scaled_edges(const std::vector<double>& root) const;
  [[nodiscard]] std::span<const Neighbour> neighbours(int node) const;
  [[nodiscard]] double residual(int node) const;
  [[nodiscard]] std::vector<int> window(int hops) const;
  void solve_window(const std::vector<int>& nodes);
  [[nodiscard]] double border_residual(const std::vector<int>& nodes) const;

  PresenceGraph graph_;
  std::vector<std::size_t> begin_;  ///< of each node in `neighbours_`
  std::vector<Neighbour> neighbours_;
  Eigen::VectorXd excess_;  ///< w0 and the observations' weights: how far the diagonal dominates
  Eigen::VectorXd b_;
  Eigen::VectorXd x_;
  std::vector<int> touched_;
  double error_bound_;  ///< infinite before the first solution
};

}  // namespace roadbook
