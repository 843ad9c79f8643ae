#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapping/layers/map_layers.hpp"
#include "speedmap/speeds/lane_speeds.hpp"
#include "workflows/report/ground_picture.hpp"

namespace roadbook {

/// Speed map and friction map of a place, with the data that a reader needs to judge them.
struct SpeedReport {
  std::optional<GroundPicture> speed;
  double min_speed = 0.0;  ///< [m/s], yellow
  double max_speed = 0.0;  ///< dark
  double coverage = 0.0;   ///< share of the places that were seen at least once
  std::string date_utc;
  std::vector<std::string> sessions;
  std::optional<GroundPicture> friction;
  std::string friction_date_utc;
  std::vector<LaneProfile> profiles;
  bool stale = false;                          ///< made on other paths than the map's current ones
  std::vector<std::vector<std::string>> ages;  ///< rows of table `layer_ages`: item, layer, date
};

/// Reads the dynamic map and the speed map. Returns nothing if the map has neither.
[[nodiscard]] std::optional<SpeedReport> collect_speeds(const MapLayers& layers);

}  // namespace roadbook
