#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbook {

/// How people move: a velocity that is forgotten (Ornstein-Uhlenbeck, each axis for itself), and
/// feet that shift.
struct PersonMotion {
  double speed = 1.0;     ///< standard deviation of the velocity, each axis [m/s]
  double memory_s = 3.0;  ///< of the velocity
  double shift = 0.05;    ///< of the feet, standard deviation after one second [m]
};

/// Kalman filter of one person's place and velocity in the plane.
class PersonFilter {
 public:
  PersonFilter(const Eigen::Vector2d& foot, const Eigen::Matrix2d& R, PersonMotion motion = {});

  void predict(double dt_s);
  /// Squared Mahalanobis distance of a sighting with covariance R; `log_determinant`: of the
  /// covariance of what is expected, added to the distance it is -2 log likelihood.
  [[nodiscard]] double distance2(const Eigen::Vector2d& foot,
                                 const Eigen::Matrix2d& R,
                                 double& log_determinant) const;
  void update(const Eigen::Vector2d& foot, const Eigen::Matrix2d& R);

  /// Transition over dt of (x, y, vx, vy) and the noise that it adds.
  static void step(const PersonMotion& motion,
                   double dt_s,
                   Eigen::Matrix4d& transition,
                   Eigen::Matrix4d& noise);

 private:
  PersonMotion motion_;
  Eigen::Vector4d mean_ = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Identity();
};

/// One sighting of a person who is followed.
struct PlacedFeet {
  double t_s = 0.0;
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};
/// Places of the feet at those times, each from all sightings (Rauch, Tung and Striebel).
[[nodiscard]] std::vector<Eigen::Vector2d> smoothed_feet(const std::vector<PlacedFeet>& sightings,
                                                         const PersonMotion& motion = {});

}  // namespace roadbook
