#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "base/se3.hpp"
#include "mapping/optimisation/least_squares_solver.hpp"
#include "mapping/optimisation/motion_residual.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

// Full bundle adjustment: estimates vehicle poses and landmarks from the pixels where the cameras
// saw the landmarks and from measured motions between poses [metric-semantic maps, section IV-B].
//
// Two solvers minimise the same cost. The own one is Levenberg-Marquardt: landmarks are eliminated
// (Schur complement), and a sparse block Cholesky factors the reduced system of the poses. It uses
// all threads and gives the same bytes on any number of them, which Ceres' Schur solvers do not.
// The other is Ceres on one thread. bench/bundle_adjustment_study compares their times.

struct BundlePose {
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  bool fixed = false;
};

/// A landmark in the adjustment.
struct BundlePoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  bool ground = false;           ///< lies on the ground: this gives the metric scale
  int ground_pose = -1;          ///< the height is known in this pose's frame; -1: not known
  double ground_height_m = 0.0;  ///< known within BundleOptions::ground_sigma_m
  bool fixed = false;            ///< does not move, for example a landmark of an existing map
};

/// A pixel where a camera saw a landmark.
struct BundleObservation {
  int pose = 0;
  int point = 0;
  int camera = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;
};

/// A measured motion between two poses.
struct MotionConstraint {
  int from = 0;
  int to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of T_from_to's right perturbation
  int scale = -1;  ///< index in `scales` of the factor on its translation; -1: none
};

/// A pose known before the adjustment.
struct PosePrior {
  int pose = 0;
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();
};

struct BundleProblem {
  std::vector<MountedCamera> cameras;
  std::vector<BundlePose> poses;
  std::vector<BundlePoint> points;
  std::vector<BundleObservation> observations;
  std::vector<MotionConstraint> motions;
  std::vector<ScaleParameter> scales;
  std::vector<PosePrior> priors;
};

enum class RobustLoss { kNone, kHuber, kCauchy };

struct BundleOptions {
  LeastSquaresSolver solver = LeastSquaresSolver::kOwn;
  int max_iterations = 30;           ///< linear solves in a round
  double relative_tolerance = 1e-6;  ///< a round ends when a step lowers the cost by less than this
  RobustLoss loss = RobustLoss::kHuber;
  double loss_width = 2.0;       ///< [standard deviations]; larger residuals lose weight
  double ground_sigma_m = 0.02;  ///< of a ground height: roughness, error of the cameras' height
  /// Rounds of removing outliers and solving again.
  int outlier_rounds = 2;
  /// Squared normalised residual of an outlier: 2 degrees of freedom, p = 1e-4.
  double max_chi2 = 18.4;
  bool fix_first_pose = true;  ///< fixes the gauge if no pose is fixed and no prior is given
  int num_threads = 0;  ///< of the own solver, 0: all cores; the result does not depend on it

  /// Throws InvalidOption.
  void check() const;
};

struct BundleResult {
  bool usable = false;  ///< finite, and the cost did not rise
  bool converged = false;
  double initial_cost = 0.0;             ///< half the sum of robust squared residuals at the start
  double final_cost = 0.0;               ///< the same at the end, over inliers
  int iterations = 0;                    ///< linear solves in all rounds
  double reprojection_rms_px = 0.0;      ///< per coordinate, sqrt(sum |r|^2 / (2 n)), over inliers
  double reprojection_median_px = 0.0;   ///< of |r|, over inliers
  std::size_t degrees_of_freedom = 0;    ///< 2 * inliers - free parameters
  std::vector<std::uint8_t> inlier;      ///< of each observation
  std::vector<std::uint8_t> point_kept;  ///< of each point: at least two inliers (or fixed)
  std::string message;
};

/// Improves `problem` in place (poses, points, scale values).
///
/// An observation is removed if its chi2 is too large, if the camera cannot see the point, or if
/// its point has no other observation. A point without observations keeps its position. If the
/// result is not usable, `problem` stays unchanged. The same bytes for any number of threads.
/// Throws BadInput for indices out of range and values that are not finite; InvalidOption;
/// Interrupted.
BundleResult bundle_adjust(BundleProblem& problem,
                           const BundleOptions& options = {},
                           const Progress& progress = {});

}  // namespace roadbook
