#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/se3.hpp"
#include "mapping/optimisation/least_squares_solver.hpp"
#include "mapping/optimisation/motion_residual.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

// The problem that bundle adjustment solves, and its options.

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
  /// Points of the same number, which follow each other, are one corner of the scene, with common
  /// errors; -1: of its own.
  int corner = -1;
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
  double loss_width = 2.0;  ///< [standard deviations]; larger residuals lose weight
  /// Length of a motion's normalised residual (6 degrees of freedom, p = 1e-4) beyond which its
  /// cost grows linearly. A false motion then pulls no harder than one at this length. Not with
  /// RobustLoss::kNone.
  double motion_loss_width = 5.28;
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

}  // namespace roadbook
