#include "vo/planar_motion.hpp"

#include <array>
#include <cmath>

namespace roadbook {

Eigen::Isometry3d planar_transform(const PlanarMotion& motion) {
  return pose_from_planar(motion.motion.x(), motion.motion.y(), motion.motion.z());
}

Matrix6d planar_information(const PlanarMotion& motion) {
  // Out of the plane a car follows the road: it pitches, rolls and climbs a little.
  const double d = motion.distance_m;
  const double sigma_height = 0.005 + 0.05 * d;
  const double sigma_tilt = 0.005 + 0.03 * std::sqrt(d);
  Eigen::Matrix3d planar = motion.covariance;
  planar.diagonal() += Eigen::Vector3d(1e-6, 1e-6, 1e-7);  // a standing car is not known for ever
  // x, y of the covariance stand in the old frame, the perturbation in the new one.
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-motion.motion.z()).toRotationMatrix();
  const Eigen::Matrix3d information = (R * planar * R.transpose()).inverse();
  Matrix6d full = Matrix6d::Zero();
  constexpr std::array<int, 3> kPlace{0, 1, 5};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      full(kPlace[i], kPlace[j]) = information(static_cast<int>(i), static_cast<int>(j));
  full(2, 2) = 1.0 / (sigma_height * sigma_height);
  full(3, 3) = full(4, 4) = 1.0 / (sigma_tilt * sigma_tilt);
  return full;
}

}  // namespace roadbook
