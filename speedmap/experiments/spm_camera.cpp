#include <cmath>

#include "speedmap/experiments/spm_world.hpp"
#include "speedmap/property_map/ipm.hpp"

namespace roadbook {

std::vector<Eigen::Vector2d> spm_pixels(const SpmExperimentOptions& options) {
  Camera camera;
  camera.model = CameraModel::kPinholeRadtan;
  camera.width = options.image_width;
  camera.height = options.image_height;
  camera.parameters = {options.focal_px, options.focal_px, 0.5 * (options.image_width - 1),
                       0.5 * (options.image_height - 1)};
  // Camera axes in the vehicle: z ahead and down by the pitch, x to the right.
  const double pitch = options.camera_pitch_rad;
  Eigen::Isometry3d T_vehicle_camera = Eigen::Isometry3d::Identity();
  T_vehicle_camera.linear().col(0) = -Eigen::Vector3d::UnitY();
  T_vehicle_camera.linear().col(1) = Eigen::Vector3d(-std::sin(pitch), 0.0, -std::cos(pitch));
  T_vehicle_camera.linear().col(2) = Eigen::Vector3d(std::cos(pitch), 0.0, -std::sin(pitch));
  T_vehicle_camera.translation().z() = options.camera_height_m;

  // From the nearest row upwards: a row, and a pixel within it, is taken when the ground has moved
  // on by the spacing since the last one taken.
  std::vector<Eigen::Vector2d> pixels;
  double last_x = -1e9;
  for (int v = options.image_height - 1; v >= 0; --v) {
    const auto middle =
        ground_point(camera, T_vehicle_camera, {}, {camera.parameters[2], static_cast<double>(v)});
    if (!middle || middle->x() > options.range_max_m) break;
    if (middle->x() < options.range_min_m || middle->x() < last_x + options.pixel_spacing_m)
      continue;
    last_x = middle->x();
    double last_y = 1e9;
    for (int u = 0; u < options.image_width; ++u) {
      const auto p = ground_point(camera, T_vehicle_camera, {},
                                  {static_cast<double>(u), static_cast<double>(v)});
      if (!p || p->y() > last_y - options.pixel_spacing_m) continue;
      last_y = p->y();
      pixels.push_back(p->head<2>());
    }
  }
  return pixels;
}

}  // namespace roadbook
