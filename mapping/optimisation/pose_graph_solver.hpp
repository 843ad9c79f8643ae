#pragma once

#include <memory>
#include <vector>

#include "mapping/optimisation/pose_graph.hpp"

namespace roadbook {

/// An edge with its part in the sum of squares.
struct WeightedEdge {
  const RelativePose* edge = nullptr;
  double weight = 1.0;  ///< times its information; 0 keeps it out
};

struct GraphState {
  std::vector<Eigen::Isometry3d> poses;
  std::vector<double> scales;
};

/// Squared normalised residual of one edge.
[[nodiscard]] double edge_chi2(const RelativePose& edge, const GraphState& state);
/// Weighted sum over all edges and the priors of the scales.
[[nodiscard]] double graph_chi2(const PoseGraph& graph,
                                const std::vector<WeightedEdge>& edges,
                                const GraphState& state);

// Levenberg-Marquardt on a fixed set of edges; only their weights change from call to call, so the
// elimination order is found once.
class GraphSolver {
 public:
  GraphSolver(const PoseGraph& graph, std::vector<const RelativePose*> edges, int num_threads);
  ~GraphSolver();

  struct Outcome {
    double chi2 = 0.0;
    int iterations = 0;
    bool converged = false;
  };
  /// Improves `state`; at most `max_iterations` linear solves.
  Outcome minimise(const std::vector<WeightedEdge>& edges,
                   GraphState& state,
                   int max_iterations,
                   double relative_tolerance);

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace roadbook
