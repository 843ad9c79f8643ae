#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "mapping/optimisation/pose_graph.hpp"

namespace roadbook {

// Relaxation of a graph of vehicle poses that odometry and loop closures join [metric-semantic
// maps, section IV-B]. Odometry is trusted. A loop may be false; a false loop must not bend the
// map.
//
// False loops are found by graduated non-convexity with the truncated quadratic (Yang et al.,
// "Graduated Non-Convexity for Robust Spatial Perception", RA-L 2020). Loops between the same two
// places see the same scene and fail together. A cluster of such loops therefore has one vote
// against odometry. The accepted loops then take part with their full information.
//
// Ceres solves the least-squares problems (mapping/optimisation/pose_graph_solver.hpp).

struct PoseGraphResult {
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<double> scales;
  std::vector<double> log_scales;           ///< of each pose; empty without PoseGraph::pose_scales
  std::vector<double> loop_weights;         ///< 0..1, of the robust solver
  std::vector<std::uint8_t> loop_accepted;  ///< took part in the final relaxation
  std::vector<double> loop_chi2;            ///< squared normalised residual at the end
  std::vector<int> component;  ///< of each pose: connected by odometry and accepted loops
  int components = 1;          ///< above 1: components that nothing joins stay where they were
  int iterations = 0;          ///< linear solves in total
  double initial_chi2 = 0.0;   ///< of odometry and accepted loops at the start values
  double final_chi2 = 0.0;     ///< the same at the result
  bool usable = false;         ///< converged to finite poses
  std::string message;
};

/// Relaxes the poses of `graph`. Runs on the calling thread and is deterministic. Throws BadInput
/// for indices out of range and values that are not finite; InvalidOption; Interrupted.
[[nodiscard]] PoseGraphResult relax(const PoseGraph& graph,
                                    const PoseGraphOptions& options = {},
                                    const Progress& progress = {});

}  // namespace roadbook
