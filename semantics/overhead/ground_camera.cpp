#include "semantics/overhead/ground_camera.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/vehicle.hpp"

namespace roadbook {

GroundCamera::GroundCamera(const MountedCamera& mounted,
                           const CarMask& mask,
                           const Eigen::Isometry3d& T_map_vehicle,
                           const OverheadOptions& options)
    : camera_(&mounted.camera),
      mask_(mask),
      options_(&options),
      T_vehicle_map_(T_map_vehicle.inverse()),
      T_camera_vehicle_(mounted.T_vehicle_camera.inverse()),
      centre_map_(T_map_vehicle * mounted.T_vehicle_camera.translation()),
      centre_vehicle_(mounted.T_vehicle_camera.translation()),
      up_map_(T_map_vehicle.linear().col(2)),
      pixels_per_radian_(mounted.camera.focal_px()),
      least_slope_(std::tan(options.min_depression_rad)) {}

bool GroundCamera::may_reach(const Eigen::AlignedBox2d& rectangle) const {
  return rectangle.exteriorDistance(centre_map_.head<2>()) <= *options_->max_range_m;
}

bool GroundCamera::masked(const Eigen::Vector2d& pixel) const {
  if (mask_.pixels == nullptr || mask_.pixels->empty()) return false;
  const auto scaled = [](double x, int from, int to) {
    return std::clamp(static_cast<int>((x + 0.5) * to / from), 0, to - 1);
  };
  const cv::Mat& mask = *mask_.pixels;
  return mask.at<std::uint8_t>(scaled(pixel.y(), camera_->height, mask.rows),
                               scaled(pixel.x(), camera_->width, mask.cols)) == 0;
}

GroundSight GroundCamera::look_at(const Eigen::Vector3d& p_map) const {
  const Eigen::Vector3d ray = p_map - centre_map_;
  const double horizontal = ray.head<2>().norm();
  const double drop = -ray.dot(up_map_);  // of the point below the camera, along the car's vertical
  if (horizontal > *options_->max_range_m || drop <= least_slope_ * horizontal) return {};
  const Eigen::Vector3d p_vehicle = T_vehicle_map_ * p_map;
  if (!mask_.body.isEmpty() && is_hidden_by_body(mask_.body, centre_vehicle_, p_vehicle)) return {};
  const auto pixel = camera_->project(T_camera_vehicle_ * p_vehicle);
  if (!pixel) return {};
  const double border = std::min(
      {pixel->x(), pixel->y(), camera_->width - 1 - pixel->x(), camera_->height - 1 - pixel->y()});
  if (border <= 0.0 || masked(*pixel)) return {};

  const double distance = ray.norm();
  const double scale = pixels_per_radian_ * options_->resolution_m *
                       std::sqrt(drop / (distance * distance * distance));
  const double inside = std::min(1.0, border / std::max(options_->border_px, 1e-9));
  if (options_->mode == OverheadMode::kMean && inside < 1.0) return {};
  const double weight =
      options_->mode == OverheadMode::kMean ? 1.0 : inside * std::min(1.0, scale * scale);
  return {static_cast<float>(pixel->x()), static_cast<float>(pixel->y()), static_cast<float>(scale),
          static_cast<float>(weight)};
}

std::optional<double> nearest_ground_m(const MountedCamera& mounted) {
  constexpr int kStepPx = 8;
  const double height = mounted.T_vehicle_camera.translation().z();
  std::optional<double> nearest;
  for (int v = 0; v < mounted.camera.height; v += kStepPx)
    for (int u = 0; u < mounted.camera.width; u += kStepPx) {
      // The last row and column are included, because a level camera sees the nearest ground there.
      const auto bearing =
          mounted.camera.bearing({std::min(u + kStepPx, mounted.camera.width) - 1,
                                  std::min(v + kStepPx, mounted.camera.height) - 1});
      if (!bearing || !mounted.camera.project(*bearing)) continue;
      const Eigen::Vector3d ray = mounted.T_vehicle_camera.linear() * *bearing;
      if (ray.z() >= 0.0) continue;
      const double distance = height * ray.head<2>().norm() / -ray.z();
      if (!nearest || distance < *nearest) nearest = distance;
    }
  return nearest;
}

}  // namespace roadbook
