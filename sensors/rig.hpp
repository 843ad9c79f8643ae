#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "sensors/camera.hpp"

namespace roadbook {

/// A camera and its pose on the vehicle.
struct MountedCamera {
  std::string name;  ///< folder in the drive: "cam0"
  Camera camera;
  Eigen::Isometry3d T_vehicle_camera = Eigen::Isometry3d::Identity();
  double time_offset_s = 0.0;  ///< to add to this camera's stamps
};

/// All cameras of a vehicle; images of one instant carry the same stamp.
struct Rig {
  std::vector<MountedCamera> cameras;
};

}  // namespace roadbook
