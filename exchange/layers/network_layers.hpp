#pragma once

#include <string>

#include "mapping/store/map_file.hpp"
#include "roadnet/network.hpp"

namespace roadbook {

/// What a consumer of the road network must know to trust or refuse it.
struct NetworkSource {
  std::string sessions;  ///< names of the sessions whose poses were used, separated by commas
  std::string date_utc;  ///< of the newest of them (utc_text)
  double sigma_m = 0.0;  ///< standard deviation of the driven positions
};

/// Writes layers `lanes` and `intersections` and table `road_network`, replacing older ones.
/// Throws Refused where two intersections or two lanes share an id.
void write_network_layers(MapUpdate& update,
                          const RoadNetwork& network,
                          const NetworkSource& source);

/// The network as it was written, bit for bit. Throws BadInput where the map has no network, or
/// where a lane names an intersection that is not there.
[[nodiscard]] RoadNetwork read_network_layers(const MapLayers& layers);

}  // namespace roadbook
