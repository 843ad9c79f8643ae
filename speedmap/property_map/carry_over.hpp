#pragma once

#include <functional>
#include <optional>

#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

/// Where a place of the old path lies in the coordinates of the new one; empty outside its tube.
using PlaceMove = std::function<std::optional<PathPlace>(const PathPlace&)>;

struct CarriedMap {
  PropertyMap map;
  std::size_t dropped = 0;  ///< knots that lie outside the new path's tube
};

/// The map after its path has moved (the metric map was optimised again, or a lane was fitted
/// again). Every knot keeps its belief and moves to the new coordinates of its ground.
/// Nothing is smoothed and no label is lost or counted twice; the knots are then no regular grid.
///
/// `period_m`: length of a new closed path. Throws Refused where no knot is left.
[[nodiscard]] CarriedMap carry_over(const PropertyMap& map,
                                    const PlaceMove& move,
                                    std::optional<double> period_m = std::nullopt);

}  // namespace roadbook
