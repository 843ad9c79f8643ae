#include "semantics/ground_camera.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {

GroundCamera::GroundCamera(const MountedCamera& mounted,
                           const cv::Mat& mask,
                           const Eigen::Isometry3d& T_map_vehicle,
                           const OverheadOptions& options)
    : camera_(&mounted.camera),
      mask_(&mask),
      options_(&options),
      T_vehicle_map_(T_map_vehicle.inverse()),
      T_camera_vehicle_(mounted.T_vehicle_camera.inverse()),
      centre_map_(T_map_vehicle * mounted.T_vehicle_camera.translation()),
      centre_vehicle_(mounted.T_vehicle_camera.translation()),
      up_map_(T_map_vehicle.linear().col(2)),
      pixels_per_radian_(mounted.camera.focal_px()),
      least_slope_(std::tan(options.min_depression_rad)) {}

bool GroundCamera::may_reach(const Eigen::AlignedBox2d& rectangle) const {
  return rectangle.exteriorDistance(centre_map_.head<2>()) <= options_->max_range_m;
}

bool GroundCamera::hidden_by_own_car(const Eigen::Vector3d& p_vehicle) const {
  const Eigen::AlignedBox3d& body = options_->own_car;
  if (body.isEmpty()) return false;
  const bool under = p_vehicle.x() > body.min().x() && p_vehicle.x() < body.max().x() &&
                     p_vehicle.y() > body.min().y() && p_vehicle.y() < body.max().y();
  if (under) return true;
  if (body.contains(centre_vehicle_)) return false;
  // Slab test of the line of sight against the body.
  double enter = 0.0;
  double leave = 1.0;
  const Eigen::Vector3d d = p_vehicle - centre_vehicle_;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(d[axis]) < 1e-9) {
      if (centre_vehicle_[axis] < body.min()[axis] || centre_vehicle_[axis] > body.max()[axis])
        return false;
      continue;
    }
    double a = (body.min()[axis] - centre_vehicle_[axis]) / d[axis];
    double b = (body.max()[axis] - centre_vehicle_[axis]) / d[axis];
    if (a > b) std::swap(a, b);
    enter = std::max(enter, a);
    leave = std::min(leave, b);
  }
  return enter < leave;
}

bool GroundCamera::masked(const Eigen::Vector2d& pixel) const {
  if (mask_->empty()) return false;
  const auto scaled = [](double x, int from, int to) {
    return std::clamp(static_cast<int>((x + 0.5) * to / from), 0, to - 1);
  };
  return mask_->at<std::uint8_t>(scaled(pixel.y(), camera_->height, mask_->rows),
                                 scaled(pixel.x(), camera_->width, mask_->cols)) == 0;
}

GroundSight GroundCamera::look_at(const Eigen::Vector3d& p_map) const {
  const Eigen::Vector3d ray = p_map - centre_map_;
  const double horizontal = ray.head<2>().norm();
  const double drop = -ray.dot(up_map_);  // of the point below the camera, along the car's vertical
  if (horizontal > options_->max_range_m || drop <= least_slope_ * horizontal) return {};
  const Eigen::Vector3d p_vehicle = T_vehicle_map_ * p_map;
  if (hidden_by_own_car(p_vehicle)) return {};
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

}  // namespace roadbook
