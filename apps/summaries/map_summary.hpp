#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/console.hpp"
#include "workflows/map_drives.hpp"

namespace roadbook {

/// Prints the result of `map`; with `--json` as one object. Stores the summary of a new build in
/// `map`, for `report` and for a later run that finds nothing to do.
void print_map(const Console& console, const MapResult& result, const std::filesystem::path& map);

/// Layers that a change of the map dropped, with the commands that make them again.
[[nodiscard]] nlohmann::ordered_json dropped_json(const std::vector<DroppedWork>& dropped);

}  // namespace roadbook
