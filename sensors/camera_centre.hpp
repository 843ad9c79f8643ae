#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>

#include "sensors/rig.hpp"

namespace roadbook {

/// Mean of the cameras' places on the vehicle [m]. Motions without a scale are motions of this
/// point: the vehicle's own origin also moves by the lever arm, which is known in metres.
[[nodiscard]] inline Eigen::Vector3d centre_of_cameras(const Rig& rig) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& mounted : rig.cameras) sum += mounted.T_vehicle_camera.translation();
  return sum / std::max(1.0, static_cast<double>(rig.cameras.size()));
}

/// Mean height [m] of the cameras above the vehicle frame's origin, which lies on the ground; empty
/// if it is not known: a calibration without a measured height states 0.
[[nodiscard]] inline std::optional<double> known_camera_height(const Rig& rig) {
  constexpr double kLeastHeightM = 0.05;
  const double height = centre_of_cameras(rig).z();
  return height > kLeastHeightM ? std::optional(height) : std::nullopt;
}

}  // namespace roadbook
