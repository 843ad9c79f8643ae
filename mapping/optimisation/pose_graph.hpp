#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "base/se3.hpp"
#include "mapping/optimisation/motion_residual.hpp"

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

/// Measured motion between two poses.
struct RelativePose {
  int from = 0;
  int to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of T_from_to's right perturbation
  int scale = -1;  ///< index in PoseGraph::scales of the factor on the translation; -1: none
};

struct PoseGraph {
  /// Start values. Within a component, poses should be chained by odometry. Components that no
  /// odometry joins may stand anywhere: loops bring them together.
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<RelativePose> odometry;
  std::vector<RelativePose> loops;
  std::vector<ScaleParameter> scales;  ///< e.g. one a session
  int fixed = 0;                       ///< this pose does not move (gauge)
};

struct PoseGraphOptions {
  int max_iterations = 100;          ///< of each least-squares solve
  double relative_tolerance = 1e-8;  ///< stop when a step lowers the cost by less than this share
  bool robust = true;                ///< false: all loops take part
  /// Squared normalised residual above which a loop is false: 6 degrees of freedom, p = 1e-4.
  double max_loop_chi2 = 27.86;
  double gnc_factor = 1.6;  ///< growth of the control parameter per step
  int cluster_span = 5;     ///< loops whose ends lie at most this many poses apart share one vote
  bool join_components = true;    ///< first place components that no odometry joins by their loops
  int min_join_loops = 2;         ///< loops that must agree before a component is placed
  double join_tolerance_m = 1.0;  ///< largest distance between placements that agree
  double join_tolerance_rad = 0.15;  ///< and largest angle between them

  /// Throws InvalidOption.
  void check() const;
};

struct PoseGraphResult {
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<double> scales;
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
