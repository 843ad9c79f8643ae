#pragma once

#include <filesystem>
#include <vector>

#include "base/messages.hpp"
#include "mapping/map.hpp"
#include "semantics/overhead/overhead.hpp"

namespace roadbook {

/// The arguments of `overhead_of_map`.
struct OverheadRequest {
  std::filesystem::path map;
  std::filesystem::path
      output;  ///< folder of the GeoTIFFs; empty: MAP without extension, _overhead
  std::vector<std::filesystem::path> drives;  ///< for sessions whose drive has moved
  std::filesystem::path vehicle;  ///< YAML with measures of the vehicle; empty: measures of the map
  OverheadOptions options;
};

struct OverheadResult {
  Map map;
  OverheadSummary summary;
  std::vector<VehicleSource> vehicles;  ///< of the sessions whose drive was available
};

/// Makes the overhead image of a map from its sessions' drives, writes it to GeoTIFFs, and stores
/// it in the map. Warns about missing drives. Throws BadInput (no drive at all), Refused (no image
/// shows ground), StorageError.
[[nodiscard]] OverheadResult overhead_of_map(const OverheadRequest& request, Messages& messages);

}  // namespace roadbook
