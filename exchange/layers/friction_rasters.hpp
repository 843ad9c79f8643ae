#pragma once

#include "mapping/store/map_file.hpp"
#include "speedmap/property_map/friction_map.hpp"

namespace roadbook {

/// Rasters NAME_mean, NAME_sigma and NAME_colours of every property. Friction is dark at 1 and
/// yellow at 0.2; others are dark at the lower end of their range and yellow at the upper.
void write_property_rasters(MapUpdate& update, const FrictionMap& friction);

}  // namespace roadbook
