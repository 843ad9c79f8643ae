#pragma once

#include <cstdint>

#include "mapping/store/map_file.hpp"
#include "speedmap/presence/map_ages.hpp"

namespace roadbook {

/// Half-lives of the content of rasters [s].
inline constexpr double kOccupancyHalfLife_s = 86400.0;        ///< parked vehicles come and go
inline constexpr double kOverheadHalfLife_s = 90.0 * 86400.0;  ///< markings
inline constexpr double kFrictionHalfLife_s = 2.0 * 86400.0;   ///< as friction in speeds

/// Names of the rasters with a row of their own in `layer_ages`, by the verbs that write them.
inline constexpr const char* kRastersWithAge[] = {"overhead", "friction_mean", "occupancy"};

/// Table `layer_ages`: date, half-life and layer of each item; weight and `stale` at `now_ns`.
[[nodiscard]] PlainTable age_table(const AgedLayers& ages, std::int64_t now_ns);

/// Writes the row of one raster (see kRastersWithAge); the other rows of the map stay.
void write_raster_age(MapUpdate& update,
                      const MapLayers& before,
                      const AgedItem& raster,
                      std::int64_t now_ns);

/// The items of table `layer_ages`; none if the map has no such table. Throws BadInput.
[[nodiscard]] AgedLayers read_layer_ages(const MapLayers& layers);

}  // namespace roadbook
