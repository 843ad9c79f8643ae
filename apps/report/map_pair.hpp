#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "workflows/report/ground_picture.hpp"

namespace roadbook {

/// One map of a pair: its raster, coloured from dark (`dark_value`) to yellow (`yellow_value`).
struct MapPanel {
  std::string title;
  std::string unit;
  double dark_value = 1.0;
  double yellow_value = 0.0;
  const GroundPicture* picture = nullptr;
};

/// Draws maps of one place side by side as one self-contained SVG. All maps have the same extent
/// and scale, axes in metres and a colour scale. Dashed lines show the middle of the lanes.
[[nodiscard]] std::string map_pair_svg(const std::vector<MapPanel>& panels,
                                       const std::vector<std::vector<Eigen::Vector2d>>& lanes);

}  // namespace roadbook
