#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "base/se3.hpp"
#include "mapping/optimisation/motion_residual.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

// Full bundle adjustment: vehicle poses and landmarks from the pixels where the cameras saw them
// and the motions measured between poses (document 004, section IV-B).
//
// Levenberg-Marquardt; landmarks are eliminated (Schur complement), the reduced system of the poses
// is factored by a sparse block Cholesky. Own code rather than Ceres, whose Schur solvers are not
// deterministic on several threads; Ceres is the judge of the
// optimum in the tests. bench/bundle_adjustment_study prints times.

struct BundlePose {
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  bool fixed = false;
};

struct BundlePoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  bool ground = false;   ///< lies on the ground under pose `ground_pose`: this gives metric scale
  int ground_pose = -1;  ///< in this pose's frame the point's height is known within ground_sigma_m
  double ground_height_m = 0.0;  ///< that height: not 0 where the ground is known not to be flat
  bool fixed = false;            ///< e.g. landmarks of a map that must not move
};

struct BundleObservation {
  int pose = 0;
  int point = 0;
  int camera = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;
};

struct MotionConstraint {
  int from = 0;
  int to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of T_from_to's right perturbation
  int scale = -1;  ///< index of the free factor on its translation; -1: none
};

/// What is known of one pose beforehand.
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
  int max_iterations = 30;           ///< of each round
  double relative_tolerance = 1e-6;  ///< a round ends when the cost falls by less than this part
  RobustLoss loss = RobustLoss::kHuber;
  double loss_width = 2.0;       ///< in standard deviations: beyond it an observation loses weight
  double ground_sigma_m = 0.02;  ///< roughness of the ground and error of the cameras' height
  /// Rounds of removing outliers and solving again.
  int outlier_rounds = 2;
  /// Squared normalised residual of an outlier: 2 degrees of freedom, p = 1e-4.
  double max_chi2 = 18.4;
  bool fix_first_pose = true;  ///< gauge, where no pose is fixed and there is no prior
  int num_threads = 0;         ///< 0: all cores; the result does not depend on it

  /// Throws InvalidOption.
  void check() const;
};

struct BundleResult {
  bool usable = false;  ///< finite, and the cost did not rise
  bool converged = false;
  double initial_cost = 0.0;  ///< half the sum of robust squared residuals, first round
  double final_cost = 0.0;    ///< of the last round, over inliers
  int iterations = 0;
  double reprojection_rms_px = 0.0;      ///< per coordinate, sqrt(sum |r|^2 / (2 n)), over inliers
  double reprojection_median_px = 0.0;   ///< of |r|, over inliers
  std::size_t degrees_of_freedom = 0;    ///< 2 * inliers - parameters (gauge taken off)
  std::vector<std::uint8_t> inlier;      ///< of each observation
  std::vector<std::uint8_t> point_kept;  ///< of each point: at least two inliers (or fixed)
  std::string message;
};

/// Improves `problem` in place (poses, points, scale values). Observations are removed where their
/// chi2 is too large, where the camera cannot see the point, and where the point has fewer than two
/// left; a point that is not kept stays where it was. The same bytes for any number of threads.
/// Throws BadInput for indices out of range and values that are not finite; InvalidOption;
/// Interrupted.
BundleResult bundle_adjust(BundleProblem& problem,
                           const BundleOptions& options = {},
                           const Progress& progress = {});

}  // namespace roadbook
