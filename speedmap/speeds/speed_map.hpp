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

/// A place of the dynamic map with all that is known of it. Speeds in m/s.
struct SpeedCell {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  PlaceClass place = PlaceClass::kOther;
  double prior = 0.0;
  double presence = 0.0;
  double sigma = 0.0;       ///< of presence
  double pedestrian = 0.0;  ///< recommended by presence
  double grip = 0.0;        ///< by friction at its quantile; infinite where it is not known
  double speed = 0.0;       ///< the lower of both, and of the law
  double speed_sigma = 0.0;
  double seen_s = 0.0;         ///< in sight, all visits
  double person_s = 0.0;       ///< a person was there
  std::int64_t visits = 0;     ///< in which it was in sight
  std::int64_t newest_ns = 0;  ///< of them; 0: never seen
};

/// Dynamic map and speed map of a place.
struct SpeedMap {
  double cell_m = 0.5;
  std::vector<SpeedCell> cells;
  std::vector<LaneProfile> profiles;
  AgedLayers ages;
  std::int64_t now_ns = 0;            ///< for which it was made
  std::int64_t date_ns = 0;           ///< of the newest visit used
  std::vector<std::string> sessions;  ///< visits in which people were looked for
  LaneSpeedOptions options;
  std::string paths;  ///< `paths_digest` of the paths that the profiles lie along

  /// Share of the places that were in sight in some visit.
  [[nodiscard]] double coverage() const;
};

/// The cell at points of the map frame; null where the dynamic map has no place. `map` must outlive
/// it, and what is made from it.
[[nodiscard]] std::function<const SpeedCell*(const Eigen::Vector2d&)> cells_of(const SpeedMap& map);
/// Presence at points, from the cells.
[[nodiscard]] PresenceAt presence_of(const SpeedMap& map);

}  // namespace roadbook
