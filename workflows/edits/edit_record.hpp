#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/edits/map_edit.hpp"
#include "mapping/store/map_bytes.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {

// The edits of a map, as the map file keeps them: table `map_edits` with the text of each edit and
// a chain of digests, and table `map_before_edits` with the map as it was without them. A build
// carries the first table over; then the edits wait to be made again.

inline constexpr const char* kEditTable = "map_edits";

/// The edits of a map, in order; empty without any. Throws BadInput if the table is damaged.
[[nodiscard]] std::vector<MapEdit> stored_edits(const std::filesystem::path& map);

/// The map without its edits; empty where it is not stored: a session came after them.
[[nodiscard]] std::optional<Map> stored_map_before_edits(const std::filesystem::path& map);

/// Writes both tables; without edits both go. `before`: null leaves the second table out.
void write_edits(MapUpdate& update, const std::vector<MapEdit>& edits, const Map* before);

}  // namespace roadbook
