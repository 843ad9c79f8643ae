#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "sensors/camera_model.hpp"

namespace roadbook {

// A camera as a function from rays to pixels and back: pinhole with radial-tangential distortion,
// Kannala-Brandt, unified omni (Mei) and double sphere.
//
// Camera frame: x right, y down, z forward. Pixels: the centre of the first pixel is (0, 0).

using Matrix23d = Eigen::Matrix<double, 2, 3>;

/// One camera's intrinsic calibration. Parameters stand in the order listed at CameraModel.
///
/// A plain value: copying costs nothing, all members are safe to call concurrently.
struct Camera {
  static constexpr int kMaxParameters = 9;

  CameraModel model = CameraModel::kPinholeRadtan;
  std::array<double, kMaxParameters> parameters{};
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  /// Rays farther off axis than this are not seen [rad]; where the model itself ends earlier, less.
  double max_angle_rad = 3.14159265358979;

  /// Pixel of a point in the camera frame (any depth, any length > 0); empty where the model cannot
  /// see it. The pixel may lie outside the image: see `contains`.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera) const;
  /// The same with d pixel / d p_camera [px/m], analytic.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera,
                                                       Matrix23d* d_pixel_d_point) const;
  /// Unit ray of a pixel; empty outside the domain of the model. Inverse of `project` to 1e-8 px.
  [[nodiscard]] std::optional<Eigen::Vector3d> bearing(const Eigen::Vector2d& pixel) const;

  /// Within the image, at least `margin_px` from its border.
  [[nodiscard]] bool contains(const Eigen::Vector2d& pixel, double margin_px = 0.0) const;
  /// The camera of the image scaled by `factor` (0.5: half size by averaging 2x2 pixels).
  [[nodiscard]] Camera scaled(double factor) const;
  /// Mean focal length [px]: converts pixels to radians near the axis.
  [[nodiscard]] double focal_px() const;
};

}  // namespace roadbook
