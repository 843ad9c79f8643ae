#pragma once

#include <limits>
#include <string>

#include "mapping/store/map_file.hpp"
#include "roadnet/network.hpp"

namespace roadbook {

/// Source, date and accuracy of a road network, by which a consumer can trust or refuse it.
struct NetworkSource {
  std::string sessions;  ///< names of the sessions whose poses were used, separated by commas
  std::string date_utc;  ///< of the newest of them (utc_text)
  /// Standard deviation of the driven positions; NaN: unknown, NULL in layers.
  double sigma_m = std::numeric_limits<double>::quiet_NaN();
};

/// Writes layers `lanes` and `intersections` and table `road_network`, replacing older ones.
/// Throws Refused where two intersections or two lanes share an id.
void write_network_layers(MapUpdate& update,
                          const RoadNetwork& network,
                          const NetworkSource& source);

/// Reads the network, with the same bits as written. Throws BadInput if the map has no network, or
/// a lane names a missing intersection.
[[nodiscard]] RoadNetwork read_network_layers(const MapLayers& layers);

}  // namespace roadbook
