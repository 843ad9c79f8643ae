#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
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
  /// Of the middle row's exposure, after the stamp of the instant. A drive sets it where cameras
  /// whose images it pairs have different time offsets; a late camera has a negative one.
  double exposed_after_s = 0.0;
  double rolling_shutter_s = 0.0;  ///< from the first row to the last; the middle row has the stamp
};

/// All cameras of a vehicle.
struct Rig {
  std::vector<MountedCamera> cameras;
};

/// Time offset [ns] of the first camera, whose stamps instants have; 0 without cameras.
[[nodiscard]] inline std::int64_t image_offset_ns(const Rig& rig) {
  return rig.cameras.empty()
             ? 0
             : static_cast<std::int64_t>(std::llround(1e9 * rig.cameras.front().time_offset_s));
}

}  // namespace roadbook
