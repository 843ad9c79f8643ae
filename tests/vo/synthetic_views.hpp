#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "base/se3.hpp"
#include "sensors/rig.hpp"
#include "tests/support/fisheye_rig.hpp"
#include "vo/features.hpp"

namespace roadbook::test {

// Corners of known place, seen by a car with fisheyes: what detection and description would give.

struct Corner {
  Eigen::Vector3d p_world;
  Descriptor descriptor;
};

/// Two thirds on walls and posts up to 3 m high, one third on the ground.
inline std::vector<Corner> corners_around(double half_size_m, int count, Random& random) {
  std::vector<Corner> corners(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i].p_world = {random.uniform(-half_size_m, half_size_m),
                          random.uniform(-half_size_m, half_size_m),
                          i % 3 == 0 ? 0.0 : random.uniform(0.1, 3.0)};
    for (auto& byte : corners[i].descriptor) byte = static_cast<std::uint8_t>(random.below(256));
  }
  return corners;
}

/// Pose of a car on a circle of `radius_m` around the origin after `distance_m`.
inline Eigen::Isometry3d on_circle(double radius_m, double distance_m) {
  const double angle = distance_m / radius_m;
  return pose_from_planar(radius_m * std::cos(angle), radius_m * std::sin(angle),
                          angle + 0.5 * std::numbers::pi);
}

/// The view of all cameras within `reach_m`: noisy pixels and descriptors with a few wrong bits.
/// `corner` holds the index of each feature's corner.
struct View {
  std::vector<Features> features;
  std::vector<std::vector<int>> corner;
};
inline View view_from(const Eigen::Isometry3d& T_world_vehicle,
                      const Rig& rig,
                      const std::vector<Corner>& corners,
                      double reach_m,
                      double sigma_px,
                      Random& random) {
  View view;
  for (const auto& mounted : rig.cameras) {
    const Eigen::Isometry3d T_camera_world = (T_world_vehicle * mounted.T_vehicle_camera).inverse();
    Features features;
    std::vector<int> seen;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector3d p = T_camera_world * corners[i].p_world;
      if (p.norm() > reach_m || p.norm() < 0.5) continue;
      const auto pixel = mounted.camera.project(p);
      if (!pixel || !mounted.camera.contains(*pixel)) continue;
      features.pixels.emplace_back(static_cast<float>(pixel->x() + random.normal(0.0, sigma_px)),
                                   static_cast<float>(pixel->y() + random.normal(0.0, sigma_px)));
      features.descriptors.push_back(corners[i].descriptor);
      for (int wrong = 0; wrong < 20; ++wrong)
        features.descriptors.back()[random.below(64)] ^=
            static_cast<std::uint8_t>(1U << random.below(8));
      seen.push_back(static_cast<int>(i));
    }
    view.features.push_back(std::move(features));
    view.corner.push_back(std::move(seen));
  }
  return view;
}

}  // namespace roadbook::test
