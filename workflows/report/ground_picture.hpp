#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapping/layers/map_layers.hpp"
#include "mapping/map.hpp"
#include "workflows/report/plan_bounds.hpp"

namespace roadbook {

/// A picture on the plane of the map, north up.
struct GroundPicture {
  std::vector<unsigned char> png;
  PlanBounds place;
};

/// Returns the map's overhead image, reduced to at most `max_px` on each side. The function reads
/// one row of tiles at a time, so that memory does not grow with the size of the place. Empty if
/// the map has no overhead image.
[[nodiscard]] std::optional<GroundPicture> overhead_picture(const MapLayers& layers,
                                                            int max_px = 1400);

/// Returns a raster layer of colours, such as `speed_colours`. Empty if the map has no such layer.
[[nodiscard]] std::optional<GroundPicture> colour_picture(const MapLayers& layers,
                                                          const std::string& name);

/// Draws the landmarks from above. A place is darker if it has more landmarks.
[[nodiscard]] GroundPicture landmark_picture(const Map& map, const PlanBounds& place);

}  // namespace roadbook
