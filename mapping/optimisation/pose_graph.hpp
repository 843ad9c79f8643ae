#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/se3.hpp"
#include "mapping/optimisation/motion_residual.hpp"

namespace roadbook {

// A graph of vehicle poses that odometry and loop closures join, and the options for its relaxation
// (mapping/optimisation/graph_relaxation.hpp).

/// Measured motion between two poses. In a graph with `PoseGraph::pose_scales`, its translation is
/// in units of `from`.
struct RelativePose {
  int from = 0;
  int to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of T_from_to's right perturbation
  int scale = -1;  ///< index in PoseGraph::scales of the factor on the translation; -1: none
  double log_scale = 0.0;        ///< measured log(metres a unit of `to` / metres a unit of `from`)
  double log_scale_sigma = 0.0;  ///< its standard deviation; 0: not measured
};

/// Scale of a pose that cameras alone measured: the similarity of its surroundings to the map.
struct PoseScale {
  double log_scale = 0.0;  ///< of metres a unit: start value
  double prior = 0.0;      ///< of `log_scale`, for example by the cameras' height; robust (Cauchy)
  double prior_sigma = 0.0;  ///< 0: no prior
  bool fixed = false;
};

struct PoseGraph {
  /// Start values. Within a component, poses should be chained by odometry. Components that no
  /// odometry joins may stand anywhere: loops bring them together.
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<RelativePose> odometry;
  std::vector<RelativePose> loops;
  std::vector<ScaleParameter> scales;  ///< e.g. one a session
  std::vector<PoseScale> pose_scales;  ///< of each pose; empty: all poses are in metres
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

}  // namespace roadbook
