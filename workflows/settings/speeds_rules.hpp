#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "mapping/store/map_file.hpp"
#include "roadnet/network.hpp"
#include "workflows/settings/speeds_config.hpp"

namespace roadbook {

/// The configuration for making speeds. The map stores it, so that the user's settings about lanes
/// and people survive when speeds are made again.
struct SpeedsRules {
  SpeedsConfig config;
  bool kept = false;  ///< stored in the map by an earlier `--config`
};

/// Returns the configuration in `file`. If `file` is empty, returns the one stored in the map, or
/// else the defaults. `vehicle_width_m` is the width of the vehicle that recorded the map, if
/// known. It applies if `file` gives no width. Throws BadInput.
[[nodiscard]] SpeedsRules speeds_rules(const MapLayers& layers,
                                       const std::filesystem::path& file,
                                       std::optional<double> vehicle_width_m);

/// Stores the configuration in table `speed_config`.
void write_speeds_rules(MapUpdate& update, const SpeedsConfig& config);

/// Returns the lanes with a limit that the network does not have. Throws BadInput, with the line,
/// if the current `file` names such a lane. Stored limits may belong to lanes that no longer exist.
[[nodiscard]] std::vector<std::uint64_t> limits_without_lane(const SpeedsConfig& config,
                                                             const RoadNetwork& network,
                                                             const std::filesystem::path& file,
                                                             const std::filesystem::path& map);

}  // namespace roadbook
