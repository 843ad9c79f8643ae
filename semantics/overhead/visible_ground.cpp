#include "semantics/overhead/visible_ground.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/cell_grid.hpp"

namespace roadbook {
namespace {

constexpr double kRayStep = 0.1;  // [m] along a bearing
constexpr int kSectors = 240;     // around a camera, for obstacles
constexpr double kTurn = 2.0 * std::numbers::pi;

int sector_of(const Eigen::Vector2d& d) {
  const double turn = std::atan2(d.y(), d.x()) / kTurn;
  return static_cast<int>(std::floor((turn - std::floor(turn)) * kSectors)) % kSectors;
}

}  // namespace

std::vector<Eigen::Vector2d> standing_cells(const Map& map,
                                            const GroundModel& ground,
                                            const VisibleGroundOptions& options) {
  std::map<GridCell<2>, int> counts;
  for (const Landmark& landmark : map.landmarks) {
    if (landmark.ground) continue;
    if (!is_known(landmark.covariance) ||
        landmark.covariance.trace() > options.max_sigma_m * options.max_sigma_m)
      continue;
    const Eigen::Vector3d p = map.p_map(landmark);
    const auto z = ground.height(p.x(), p.y());
    if (!z || p.z() - *z < options.lowest_m || p.z() - *z > options.highest_m) continue;
    ++counts[cell_at<2>(p.head<2>(), options.cell_m)];
  }
  std::vector<Eigen::Vector2d> cells;
  for (const auto& [cell, count] : counts)
    if (count >= options.fewest_landmarks)
      cells.emplace_back(options.cell_m * (static_cast<double>(cell[0]) + 0.5),
                         options.cell_m * (static_cast<double>(cell[1]) + 0.5));
  return cells;
}

VisibleGround::VisibleGround(const Map& map,
                             const GroundModel& ground,
                             const std::vector<PersonCamera>& cameras,
                             const VisibleGroundOptions& options)
    : options_(options), obstacles_(standing_cells(map, ground, options)) {
  double farthest = 0.0;
  for (const PersonCamera& camera : cameras) {
    camera_places_.emplace_back(camera.mounted().T_vehicle_camera.translation().head<2>());
    farthest = std::max(farthest, camera_places_.back().norm());
  }
  steps_ = static_cast<int>((options_.max_range_m + farthest) / kRayStep);
  seen_by_.assign(static_cast<std::size_t>(kBearings * steps_), 0);
  for (int b = 0; b < kBearings; ++b)
    for (int i = 0; i < steps_; ++i) {
      const double angle = kTurn * (b + 0.5) / kBearings;
      const Eigen::Vector2d p =
          kRayStep * (i + 0.5) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      for (std::size_t c = 0; c < cameras.size(); ++c) {
        const PersonBox box = box_of_person(static_cast<int>(c), cameras[c].mounted(),
                                            {p.x(), p.y(), 0.0}, options_.person_m);
        const bool seen = (p - camera_places_[c]).norm() <= options_.max_range_m &&
                          cameras[c].sees(box.azimuth, box.foot_slope) &&
                          cameras[c].sees(box.azimuth, box.foot_slope + box.size);
        if (seen)
          seen_by_[static_cast<std::size_t>(b * steps_ + i)] |= static_cast<std::uint16_t>(1U << c);
      }
    }
}

std::vector<double> VisibleGround::reach_m(const Eigen::Isometry3d& T_map_vehicle,
                                           const std::vector<bool>& has_image) const {
  const Eigen::Isometry3d T_vehicle_map = T_map_vehicle.inverse();
  // For each camera and direction, the distance to the nearest obstacle.
  std::vector<std::vector<double>> free_m(camera_places_.size(),
                                          std::vector<double>(kSectors, 1e9));
  for (const Eigen::Vector2d& cell : obstacles_) {
    const Eigen::Vector2d p =
        (T_vehicle_map * Eigen::Vector3d(cell.x(), cell.y(), T_map_vehicle.translation().z()))
            .head<2>();
    if (p.norm() > steps_ * kRayStep + 1.0) continue;
    for (std::size_t c = 0; c < camera_places_.size(); ++c) {
      const Eigen::Vector2d d = p - camera_places_[c];
      if (d.norm() < options_.cell_m) continue;
      const int half = static_cast<int>(0.5 * options_.cell_m / d.norm() / kTurn * kSectors);
      for (int k = -half; k <= half; ++k) {
        double& least =
            free_m[c][static_cast<std::size_t>((sector_of(d) + k + kSectors) % kSectors)];
        least = std::min(least, d.norm());
      }
    }
  }
  std::vector<double> reach(kBearings, 0.0);
  for (int b = 0; b < kBearings; ++b) {
    bool begun = false;
    for (int i = 0; i < steps_; ++i) {
      const double angle = kTurn * (b + 0.5) / kBearings;
      const Eigen::Vector2d p =
          kRayStep * (i + 0.5) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      bool seen = false;
      for (std::size_t c = 0; c < camera_places_.size(); ++c) {
        const bool by = (seen_by_[static_cast<std::size_t>(b * steps_ + i)] >> c & 1U) != 0;
        const Eigen::Vector2d d = p - camera_places_[c];
        seen = seen ||
               (by && has_image[c] && d.norm() < free_m[c][static_cast<std::size_t>(sector_of(d))]);
      }
      if (begun && !seen) break;
      begun = begun || seen;
      if (seen) reach[static_cast<std::size_t>(b)] = kRayStep * (i + 1);
    }
  }
  return reach;
}

}  // namespace roadbook
