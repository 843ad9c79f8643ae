#pragma once

#include <functional>
#include <optional>

#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

/// Converts a position in coordinates of the old path to those of the new path; empty outside the
/// tube of the new path.
using PlaceMove = std::function<std::optional<PathPlace>(const PathPlace&)>;

struct CarriedMap {
  PropertyMap map;
  std::size_t dropped = 0;  ///< knots that lie outside the new path's tube
};

/// Moves a map to a new path, after the metric map was optimised or a lane was fitted again. Every
/// knot keeps its belief and gets the coordinates of its ground on the new path. Nothing is
/// smoothed, and no label is lost or counted twice. The knots then no longer form a regular grid.
///
/// `period_m`: length of the new path if it is closed. Throws Refused if no knot is left.
[[nodiscard]] CarriedMap carry_over(const PropertyMap& map,
                                    const PlaceMove& move,
                                    std::optional<double> period_m = std::nullopt);

}  // namespace roadbook
