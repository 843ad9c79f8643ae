#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

namespace roadbook::test {

// Independent fisheye model: the radius is an odd polynomial of the angle off axis.
struct OwnLens {
  double focal = 400.0;
  double centre_u = 640.0;
  double centre_v = 400.0;
  double k1 = 0.0, k2 = 0.0, k3 = 0.0, k4 = 0.0;
  double stretch = 1.0;  ///< horizontal radius over `focal`; the vertical one is shrunk as much

  [[nodiscard]] std::optional<Eigen::Vector2d> see(const Eigen::Vector3d& p) const {
    const double across = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const double angle = std::atan2(across, p.z());
    if (angle > 1.6 || across < 1e-9) return std::nullopt;
    const double a3 = angle * angle * angle;
    const double a5 = a3 * angle * angle;
    const double a7 = a5 * angle * angle;
    const double radius = focal * (angle + k1 * a3 + k2 * a5 + k3 * a7 + k4 * a7 * angle * angle);
    return Eigen::Vector2d(centre_u + radius * stretch * p.x() / across,
                           centre_v + radius * (2.0 - stretch) * p.y() / across);
  }
};

// Pose of a camera; columns of `axes`: its right, down and forward in the vehicle frame.
struct OwnCamera {
  OwnLens lens;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double latency_s = 0.0;
  double shutter_s = 0.0;
};

}  // namespace roadbook::test
