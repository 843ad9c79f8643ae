#pragma once

#include <filesystem>
#include <optional>

#include "base/messages.hpp"
#include "exchange/layers/friction_carry.hpp"
#include "roadnet/build_network.hpp"
#include "roadnet/network.hpp"
#include "roadnet/paths/lane_path.hpp"
#include "roadnet/routing/lane_link.hpp"
#include "speedmap/property_map/friction_map.hpp"

namespace roadbook {

/// The arguments of `find_roads`.
struct RoadsRequest {
  std::filesystem::path map;
  RoadNetworkOptions options;
  LanePathOptions paths;
  std::optional<double> vehicle_width_m;  ///< empty: width stored in the map, else 1.9
  int num_threads = 0;                    ///< 0: all cores
};

/// The largest deviation and curvature over the paths of all lanes.
struct PathSummary {
  double deviation_m = 0.0;    ///< from the driven line
  double max_curvature = 0.0;  ///< [1/m]
  int deviating = 0;           ///< paths that deviate more than allowed
};

struct RoadsResult {
  RoadNetwork network;
  PathSummary paths;
  std::size_t spaces = 0;                 ///< parking spaces of the map
  std::size_t spaces_linked = 0;          ///< of these, spaces with a lane in front of them
  std::optional<FrictionCarry> friction;  ///< how the friction map was carried to the new paths
  bool speeds_stale = false;              ///< the speed map belongs to other paths
};

/// Finds lanes and intersections of a map, fits a path to each lane, links parking spaces to lanes,
/// and stores all in the map. Warns through `messages` where driven ground has no lane.
/// Throws BadInput, InvalidOption, Refused (nothing driven, coverage below 0.5), StorageError.
[[nodiscard]] RoadsResult find_roads(const RoadsRequest& request, const Messages& messages);

}  // namespace roadbook
