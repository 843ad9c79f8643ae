#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "semantics/overhead/overhead_options.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

/// Projection of a ground point into a camera image, with its weight in the mosaic.
struct GroundSight {
  float u = 0.0F;  ///< pixel of the full image
  float v = 0.0F;
  float scale = 0.0F;   ///< image pixels per overhead pixel, along a side (geometric mean)
  float weight = 0.0F;  ///< 0: not seen
};

/// Parts of the own vehicle that hide ground from a camera.
struct CarMask {
  const cv::Mat* pixels = nullptr;  ///< CV_8U of any size, 0: own vehicle; null or empty: no mask
  Eigen::AlignedBox3d body;         ///< vehicle frame; empty: hides nothing
};

/// A camera at one pose, for projecting ground points. Thread-safe.
///
/// The weight is the number of image pixels that one overhead pixel covers, at most 1: the solid
/// angle of the ground cell, cos(incidence) / distance^2, times the camera's pixels per steradian.
/// Beyond 1 a closer view shows no more at this resolution. Towards the image border it falls to 0.
class GroundCamera {
 public:
  /// Keeps references to `mounted`, the mask's pixels and `options`. `options.max_range_m` must be
  /// set.
  GroundCamera(const MountedCamera& mounted,
               const CarMask& mask,
               const Eigen::Isometry3d& T_map_vehicle,
               const OverheadOptions& options);

  [[nodiscard]] GroundSight look_at(const Eigen::Vector3d& p_map) const;
  /// True if a point of the rectangle (map x, y) may be within range.
  [[nodiscard]] bool may_reach(const Eigen::AlignedBox2d& rectangle) const;

 private:
  [[nodiscard]] bool masked(const Eigen::Vector2d& pixel) const;

  const Camera* camera_;
  CarMask mask_;
  const OverheadOptions* options_;
  Eigen::Isometry3d T_vehicle_map_;
  Eigen::Isometry3d T_camera_vehicle_;
  Eigen::Vector3d centre_map_;
  Eigen::Vector3d centre_vehicle_;
  Eigen::Vector3d up_map_;
  double pixels_per_radian_;
  double least_slope_;
};

/// Horizontal distance from the camera to the nearest level ground in its image [m]; empty if the
/// image shows no ground.
[[nodiscard]] std::optional<double> nearest_ground_m(const MountedCamera& mounted);

}  // namespace roadbook
