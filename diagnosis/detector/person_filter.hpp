#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbook {

/// Motion model of a pedestrian: an Ornstein-Uhlenbeck velocity, independent on each axis, and a
/// random walk of the ground position.
struct PersonMotion {
  double speed = 1.0;     ///< standard deviation of the velocity, each axis [m/s]
  double memory_s = 3.0;  ///< correlation time of the velocity
  double shift =
      0.05;  ///< random walk of the ground position, standard deviation after one second [m]
};

/// Kalman filter of one pedestrian's position and velocity in the plane.
class PersonFilter {
 public:
  PersonFilter(const Eigen::Vector2d& foot, const Eigen::Matrix2d& R, PersonMotion motion = {});

  void predict(double dt_s);
  /// Squared Mahalanobis distance of a detection with covariance `R` [m^2]. `log_determinant`: that
  /// of the innovation covariance; distance plus log determinant is -2 log likelihood.
  [[nodiscard]] double distance2(const Eigen::Vector2d& foot,
                                 const Eigen::Matrix2d& R,
                                 double& log_determinant) const;
  void update(const Eigen::Vector2d& foot, const Eigen::Matrix2d& R);

  /// Transition matrix of (x, y, vx, vy) over `dt_s` and the added noise covariance.
  static void step(const PersonMotion& motion,
                   double dt_s,
                   Eigen::Matrix4d& transition,
                   Eigen::Matrix4d& noise);

 private:
  PersonMotion motion_;
  Eigen::Vector4d mean_ = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Identity();
};

/// One detection of a tracked pedestrian.
struct PlacedFeet {
  double t_s = 0.0;
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};
/// Smoothed ground positions at the times of the detections (Rauch, Tung and Striebel 1965).
[[nodiscard]] std::vector<Eigen::Vector2d> smoothed_feet(const std::vector<PlacedFeet>& sightings,
                                                         const PersonMotion& motion = {});

}  // namespace roadbook
