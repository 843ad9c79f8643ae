#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "sensors/rig.hpp"

namespace roadbook::test {

/// Fisheyes of 640 x 480 around a car, the first looking ahead, the next ones to the left.
inline Rig fisheye_rig(int cameras = 4) {
  Rig rig;
  for (int c = 0; c < cameras; ++c) {
    MountedCamera mounted;
    mounted.name = "cam" + std::to_string(c);
    mounted.camera.model = CameraModel::kKannalaBrandt;
    mounted.camera.parameters = {200.0, 200.0, 319.5, 239.5, -0.01, 0.002, -0.001, 0.0001, 0.0};
    mounted.camera.width = 640;
    mounted.camera.height = 480;
    const double yaw = 0.5 * std::numbers::pi * c;
    Eigen::Matrix3d forward;  // camera axes in the vehicle frame when it looks ahead
    forward << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    mounted.T_vehicle_camera.linear() =
        Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * forward;
    mounted.T_vehicle_camera.translation() =
        Eigen::Vector3d(1.3 + 1.5 * std::cos(yaw), std::sin(yaw), 0.9);
    rig.cameras.push_back(mounted);
  }
  return rig;
}

}  // namespace roadbook::test
