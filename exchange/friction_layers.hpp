#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mapping/map_file.hpp"
#include "speedmap/lane_strips.hpp"
#include "speedmap/property_map.hpp"
#include "speedmap/slice.hpp"

namespace roadbook {

/// A friction map as a map file keeps it: reads back to the same numbers, and can be extended.
struct FrictionMap {
  LaneStrips strips;
  PropertyMap map;
  double spacing_m = 1.0;  ///< of the knots
  double kernel_width_m = 2.0;
  std::int64_t date_ns = 0;           ///< of the newest measurement
  std::vector<std::string> sessions;  ///< names of those that were used
  std::size_t dropped = 0;            ///< knots of lanes that are no more
};

/// Writes layer `friction` (a point a knot) and tables `friction_settings`, `friction_knots` and
/// `property_classes`, replacing older ones.
void write_friction_layers(MapUpdate& update, const FrictionMap& friction);

/// The friction map over the lanes as they are now; none where `friction` was never run. Knots stay
/// at their share of their lane's length and at their e: they go with a path that has moved. Lanes
/// that are new have knots that know nothing. What the classes have learned is their prior now.
/// Throws BadInput for tables that do not fit together.
[[nodiscard]] std::optional<FrictionMap> read_friction_layers(const MapLayers& layers,
                                                              const std::vector<LanePath>& lanes);

/// A slice of one lane in the lane's own s; of a ring, around its seam.
[[nodiscard]] PropertySlice lane_slice(const FrictionMap& friction,
                                       const LaneStrips::Strip& strip,
                                       double from_m,
                                       double to_m,
                                       const std::string& map_name);

}  // namespace roadbook
