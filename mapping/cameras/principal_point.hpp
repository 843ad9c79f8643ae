#pragma once

#include <Eigen/Core>

#include "sensors/camera.hpp"

namespace roadbook {

/// Pixel of the optical axis (cu, cv).
[[nodiscard]] inline Eigen::Vector2d principal_point(const Camera& camera) {
  const auto& p = camera.parameters;
  switch (camera.model) {
    case CameraModel::kOmni:
      return {p[3], p[4]};
    case CameraModel::kDoubleSphere:
      return {p[4], p[5]};
    default:
      return {p[2], p[3]};
  }
}

}  // namespace roadbook
