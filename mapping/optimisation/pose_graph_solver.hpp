#pragma once

#include <memory>
#include <vector>

#include "mapping/optimisation/pose_graph.hpp"

namespace roadbook {

/// An edge of the graph and its weight in the sum of squares.
struct WeightedEdge {
  const RelativePose* edge = nullptr;
  double weight = 1.0;  ///< factor on the edge's information; 0 takes the edge out
};

/// The unknowns of a pose graph: poses and factors on measured translations.
struct GraphState {
  std::vector<Eigen::Isometry3d> poses;  ///< T_map_vehicle
  std::vector<double> scales;
  std::vector<double> log_scales;  ///< of the poses (PoseGraph::pose_scales)
};

/// Squared normalised residual of one edge.
[[nodiscard]] double edge_chi2(const RelativePose& edge, const GraphState& state);
/// Weighted sum of squared normalised residuals over all edges and the priors of the scales.
[[nodiscard]] double graph_chi2(const PoseGraph& graph,
                                const std::vector<WeightedEdge>& edges,
                                const GraphState& state);

/// Least squares on a fixed set of edges by Ceres: Levenberg-Marquardt, sparse Cholesky of the
/// normal equations. Only the weights of the edges change from call to call.
///
/// Ceres runs on one thread, because its sum of the cost over several threads depends on their
/// timing. Eigen's Cholesky is used, because CHOLMOD's bits depend on the installed BLAS.
class GraphSolver {
 public:
  /// `edges` must stay where they are while the solver lives.
  GraphSolver(const PoseGraph& graph, std::vector<const RelativePose*> edges);
  ~GraphSolver();

  struct Outcome {
    int iterations = 0;  ///< linear solves
    bool converged = false;
  };
  /// Improves `state` by at most `max_iterations` linear solves. `edges`: those of the constructor,
  /// in the same order. Converged when a step lowers the cost by less than `relative_tolerance` of
  /// it; that step still counts.
  Outcome minimise(const std::vector<WeightedEdge>& edges,
                   GraphState& state,
                   int max_iterations,
                   double relative_tolerance);

 private:
  struct Unknowns;
  std::unique_ptr<Unknowns> unknowns_;
};

}  // namespace roadbook
