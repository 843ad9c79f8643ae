#include "semantics/people/person_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbook {

namespace {

/// The point where the ray through the feet meets the ground.
struct FootHit {
  double range_m = 0.0;
  double closing = 0.0;  ///< slope of the ground minus slope of the ray, at that point
};

// `c`, `ahead`: camera centre and horizontal direction of the ray, vehicle frame. `slope`: slope of
// the ray.
std::optional<FootHit> foot_hit(const Eigen::Vector3d& c,
                                const Eigen::Vector2d& ahead,
                                double slope,
                                const Eigen::Isometry3d& T_map_vehicle,
                                const GroundModel& ground) {
  constexpr double kFarthest = 100.0;
  // Height of the ground over the vehicle's plane at a distance along the ray.
  const auto height_at = [&](double range_m) {
    const Eigen::Vector2d p = c.head<2>() + range_m * ahead;
    const Eigen::Vector3d p_map = T_map_vehicle * Eigen::Vector3d(p.x(), p.y(), 0.0);
    const auto z = ground.height(p_map.x(), p_map.y());
    return z ? *z - p_map.z() : 0.0;
  };
  // The ray goes below the ground at a distance between 0 and kFarthest.
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
  const double closing = -(above(range_m + 0.05) - above(range_m - 0.05)) / 0.1;
  if (!(closing > 1e-3)) return std::nullopt;
  return FootHit{range_m, closing};
}

/// A person, and the cameras that have found this person.
struct Sighted {
  PlacedPerson person;
  std::vector<int> cameras;
};

// Merges two estimates, each weighted by its covariance. A camera knows the place badly along its
// ray and well across its ray, so two cameras complement each other.
void take_in(const PlacedPerson& person, Sighted& same) {
  PlacedPerson& one = same.person;
  const Eigen::Matrix2d gain = one.covariance * (one.covariance + person.covariance).inverse();
  one.foot += gain * (person.foot - one.foot);
  const Eigen::Matrix2d left = (Eigen::Matrix2d::Identity() - gain) * one.covariance;
  one.covariance = 0.5 * (left + left.transpose());
  same.cameras.push_back(person.box.camera);
}

}  // namespace

std::optional<PlacedPerson> place_on_ground(const PersonHypothesis& found,
                                            const MountedCamera& mounted,
                                            const Eigen::Isometry3d& T_map_vehicle,
                                            const GroundModel& ground,
                                            const PersonPlaceOptions& options) {
  const Eigen::Vector3d c = mounted.T_vehicle_camera.translation();
  const PersonBox& box = found.box;
  const Eigen::Vector2d ahead(std::cos(box.azimuth), std::sin(box.azimuth));
  const auto hit = foot_hit(c, ahead, box.foot_slope, T_map_vehicle, ground);
  if (!hit) return std::nullopt;
  const double range_m = hit->range_m;
  const double height_m = box.size * range_m;
  const double off = 2.0 * std::sqrt(2.0) * options.sigma_foot_px / PersonWindow::kPerson;
  if (height_m < options.min_height_m * (1.0 - off) ||
      height_m > options.max_height_m * (1.0 + off))
    return std::nullopt;
  PlacedPerson placed;
  placed.box = box;
  placed.probability = found.prediction.probability;
  const double px = box.size / PersonWindow::kPerson;
  // The height from feet and crown has errors: the variation of people's heights and the errors of
  // both slopes. The difference from the mean height corrects the range (one step of a Kalman
  // filter).
  const double metres = range_m / hit->closing;  // derivative of the range by the slope of the feet
  const double own = std::pow(options.sigma_foot_px * px, 2);
  const double shared =
      std::pow(options.sigma_tilt_rad, 2) + std::pow(options.sigma_ground_m / range_m, 2);
  const double of_foot = box.size * metres - range_m;
  const double with_height = metres * (of_foot * own + box.size * metres * shared);
  const double height_variance = std::pow(options.sigma_height_m, 2) +
                                 (of_foot * of_foot + range_m * range_m) * own +
                                 std::pow(box.size * metres, 2) * shared;
  const double gain = with_height / height_variance;
  const double corrected_m =
      std::max(0.5 * range_m, range_m - gain * (height_m - options.mean_height_m));
  const double along = std::sqrt(metres * metres * (own + shared) - gain * with_height);
  placed.foot = c.head<2>() + corrected_m * ahead;
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
  std::vector<Sighted> kept;
  for (const PlacedPerson& person : people) {
    Sighted* same = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (Sighted& other : kept) {
      if (std::count(other.cameras.begin(), other.cameras.end(), person.box.camera) > 0) continue;
      const Eigen::Vector2d d = person.foot - other.person.foot;
      const Eigen::Matrix2d both = person.covariance + other.person.covariance;
      const double off = d.dot(both.inverse() * d);
      if (off >= nearest || (off >= 9.0 && d.norm() >= within_m)) continue;
      nearest = off;
      same = &other;
    }
    if (same == nullptr)
      kept.push_back({person, {person.box.camera}});
    else
      take_in(person, *same);
  }
  std::vector<PlacedPerson> merged;
  for (Sighted& one : kept) merged.push_back(std::move(one.person));
  return merged;
}

}  // namespace roadbook
