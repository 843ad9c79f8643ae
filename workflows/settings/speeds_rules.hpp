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
  bool kept = false;  ///< in the map, by an earlier `--config`
};

/// Those of `file`; where that is empty, those that the map keeps; else the defaults.
/// `vehicle_width_m`: of the vehicle that recorded the map, where the map knows it; the width that
/// `file` does not name. Throws BadInput.
[[nodiscard]] SpeedsRules speeds_rules(const MapLayers& layers,
                                       const std::filesystem::path& file,
                                       std::optional<double> vehicle_width_m);

/// Keeps them in table `speed_config`.
void write_speeds_rules(MapUpdate& update, const SpeedsConfig& config);

/// Lanes with a limit that the network does not have. Throws BadInput for them, with their line,
/// where `file`, given now, names them; kept limits may be of lanes that are no more.
[[nodiscard]] std::vector<std::uint64_t> limits_without_lane(const SpeedsConfig& config,
                                                             const RoadNetwork& network,
                                                             const std::filesystem::path& file,
                                                             const std::filesystem::path& map);

}  // namespace roadbook
