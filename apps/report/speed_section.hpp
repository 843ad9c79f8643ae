#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/report/report_data.hpp"
#include "mapping/map_layers.hpp"

namespace roadbook {

/// Speed map and friction map of a place, with what a reader must know to trust them.
struct SpeedReport {
  std::optional<GroundPicture> speed;
  double min_speed = 0.0;  ///< [m/s], yellow
  double max_speed = 0.0;  ///< dark
  double coverage = 0.0;   ///< share of the places that were ever seen
  std::string date_utc;
  std::vector<std::string> sessions;
  std::optional<GroundPicture> friction;
  std::string friction_date_utc;
  std::vector<std::vector<std::string>> ages;  ///< rows of table `layer_ages`: item, layer, date
};

/// What the map has of them; none where it has neither.
[[nodiscard]] std::optional<SpeedReport> collect_speeds(const MapLayers& layers);

/// Both maps side by side with their legends, as HTML; `lanes` are drawn over them.
[[nodiscard]] std::string speed_figures(const SpeedReport& report,
                                        const std::vector<std::vector<Eigen::Vector2d>>& lanes);

}  // namespace roadbook
