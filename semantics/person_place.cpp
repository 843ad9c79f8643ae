#include "semantics/person_place.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {

std::optional<PlacedPerson> place_on_ground(const PersonHypothesis& found,
                                            const MountedCamera& mounted,
                                            const Eigen::Isometry3d& T_map_vehicle,
                                            const GroundModel& ground,
                                            const PersonPlaceOptions& options) {
  constexpr double kFarthest = 100.0;
  const Eigen::Vector3d c = mounted.T_vehicle_camera.translation();
  const PersonBox& box = found.box;
  const Eigen::Vector2d ahead(std::cos(box.azimuth), std::sin(box.azimuth));
  const double slope = box.foot_slope;
  // Height of the ground over the vehicle's plane at a distance along the ray.
  const auto height_at = [&](double range_m) {
    const Eigen::Vector2d p = c.head<2>() + range_m * ahead;
    const Eigen::Vector3d p_map = T_map_vehicle * Eigen::Vector3d(p.x(), p.y(), 0.0);
    const auto z = ground.height(p_map.x(), p_map.y());
    return z ? *z - p_map.z() : 0.0;
  };
  // The ray falls below the ground somewhere between 0 and kFarthest.
  const auto above = [&](double r) { return c.z() + slope * r - height_at(r); };
  double near = 0.0;
  double far = 0.0;
  constexpr double kStep = 0.5;
  while (far < kFarthest && above(far) > 0.0) {
    near = far;
    far += kStep;
  }
  if (!(far > 0.0) || far >= kFarthest) return std::nullopt;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (near + far);
    (above(middle) > 0.0 ? near : far) = middle;
  }
  const double range_m = 0.5 * (near + far);
  const double closing = -(above(range_m + 0.05) - above(range_m - 0.05)) / 0.1;  // slopes meeting
  if (!(closing > 1e-3)) return std::nullopt;
  PlacedPerson placed;
  placed.box = box;
  placed.probability = found.prediction.probability;
  placed.foot = c.head<2>() + range_m * ahead;
  const double px = box.size / PersonWindow::kPerson;
  const double sigma_slope = std::hypot(options.sigma_foot_px * px, options.sigma_tilt_rad,
                                        options.sigma_ground_m / range_m);
  const double along = range_m * sigma_slope / closing;
  const double across = range_m * std::hypot(options.sigma_side_px * px, options.sigma_tilt_rad);
  const Eigen::Vector2d aside(-ahead.y(), ahead.x());
  placed.covariance =
      along * along * ahead * ahead.transpose() + across * across * aside * aside.transpose();
  return placed;
}

std::vector<PlacedPerson> merge_cameras(std::vector<PlacedPerson> people, double within_m) {
  std::stable_sort(people.begin(), people.end(), [](const PlacedPerson& a, const PlacedPerson& b) {
    return a.probability > b.probability;
  });
  std::vector<PlacedPerson> kept;
  for (const PlacedPerson& person : people) {
    const bool again = std::any_of(kept.begin(), kept.end(), [&](const PlacedPerson& other) {
      if (other.box.camera == person.box.camera) return false;
      const Eigen::Vector2d d = person.foot - other.foot;
      const Eigen::Matrix2d both = person.covariance + other.covariance;
      return d.norm() < within_m || d.dot(both.inverse() * d) < 9.0;
    });
    if (!again) kept.push_back(person);
  }
  return kept;
}

}  // namespace roadbook
