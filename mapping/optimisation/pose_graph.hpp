#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "base/se3.hpp"
#include "mapping/optimisation/motion_residual.hpp"

namespace roadbook {

// Relaxes a graph of vehicle poses joined by odometry and by loop closures (document 004, section
// IV-B). Odometry is trusted; each loop may be false and must then not bend the map.
//
// False loops are found by graduated non-convexity with the truncated quadratic (Yang et al.,
// "Graduated Non-Convexity for Robust Spatial Perception", RA-L 2020). Loops between the same two
// places see the same scene and fail together: a cluster of them counts as one piece of evidence
// against odometry, however many they are. The accepted ones then take part with their full
// information.

/// Measured motion between two poses.
struct RelativePose {
  int from = 0;
  int to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of T_from_to's right perturbation
  int scale = -1;  ///< index of the factor on its translation; -1: none
};

struct PoseGraph {
  /// Start values. Poses chained by odometry should be consistent with it; pieces without odometry
  /// between them may stand anywhere, loops bring them together.
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<RelativePose> odometry;
  std::vector<RelativePose> loops;
  std::vector<ScaleParameter> scales;  ///< e.g. one a session
  int fixed = 0;                       ///< this pose does not move (gauge)
};

struct PoseGraphOptions {
  int max_iterations = 100;          ///< of each least-squares solve
  double relative_tolerance = 1e-8;  ///< stop when the cost falls by less than this part
  bool robust = true;                ///< false: all loops are believed
  /// Squared normalised residual above which a loop is false: 6 degrees of freedom, p = 1e-4.
  double max_loop_chi2 = 27.86;
  double gnc_factor = 1.6;  ///< growth of the control parameter per step
  int cluster_span = 5;     ///< loops whose ends lie at most this many poses apart share one vote
  bool join_pieces = true;  ///< place pieces without odometry between them by their loops first
  int min_join_loops = 2;   ///< that many loops must agree before a piece is joined to the others
  double join_tolerance_m = 1.0;  ///< within which they agree
  double join_tolerance_rad = 0.15;
  int num_threads = 0;  ///< 0: all cores; the result does not depend on it

  /// Throws InvalidOption.
  void check() const;
};

struct PoseGraphResult {
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<double> scales;
  std::vector<double> loop_weights;         ///< 0..1, of the robust solver
  std::vector<std::uint8_t> loop_accepted;  ///< took part in the final relaxation
  std::vector<double> loop_chi2;            ///< squared normalised residual at the end
  std::vector<int> piece;     ///< of each pose: what odometry and accepted loops connect
  int pieces = 1;             ///< more than 1: a piece that nothing joins stays where it was
  int iterations = 0;         ///< linear solves in total
  double initial_chi2 = 0.0;  ///< of odometry and accepted loops at the start values
  double final_chi2 = 0.0;    ///< the same at the result
  bool usable = false;        ///< converged to finite poses
  std::string message;
};

/// Relaxed poses. Deterministic for any number of threads. Throws BadInput for indices out of range
/// and values that are not finite; InvalidOption; Interrupted.
[[nodiscard]] PoseGraphResult relax(const PoseGraph& graph,
                                    const PoseGraphOptions& options = {},
                                    const Progress& progress = {});

}  // namespace roadbook
