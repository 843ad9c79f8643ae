#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "speedmap/presence/map_ages.hpp"
#include "speedmap/presence/presence_grid.hpp"
#include "speedmap/speeds/lane_speeds.hpp"

namespace roadbook {

/// A cell of the dynamic map with its presence and speeds [m/s].
struct SpeedCell {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  PlaceClass place = PlaceClass::kOther;
  double prior = 0.0;
  double presence = 0.0;
  double sigma = 0.0;       ///< standard deviation of presence
  double pedestrian = 0.0;  ///< recommended speed by presence
  double grip = 0.0;        ///< speed by friction at its quantile; infinite if unknown
  double speed = 0.0;       ///< the lowest of both and of the speed limit
  double speed_sigma = 0.0;
  double seen_s = 0.0;         ///< time in sight, all visits
  double person_s = 0.0;       ///< time with a person there
  std::int64_t visits = 0;     ///< visits in which it was in sight
  std::int64_t newest_ns = 0;  ///< the newest of these visits; 0: never in sight
};

/// Dynamic map and speed map of a place.
struct SpeedMap {
  double cell_m = 0.5;
  std::vector<SpeedCell> cells;
  std::vector<LaneProfile> profiles;
  AgedLayers ages;
  std::int64_t now_ns = 0;            ///< time for which ages were computed
  std::int64_t date_ns = 0;           ///< of the newest visit used
  std::vector<std::string> sessions;  ///< visits in which people were searched for
  LaneSpeedOptions options;
  std::string paths;  ///< `paths_digest` of the paths of the profiles

  /// Share of the cells that were in sight in some visit.
  [[nodiscard]] double coverage() const;
};

/// Returns a function that finds the cell at a point of the map frame; null where there is no cell.
/// `map` must outlive the function and its results.
[[nodiscard]] std::function<const SpeedCell*(const Eigen::Vector2d&)> cells_of(const SpeedMap& map);
/// Presence at points, from the cells.
[[nodiscard]] PresenceAt presence_of(const SpeedMap& map);

}  // namespace roadbook
