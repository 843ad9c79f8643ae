#pragma once

#include <filesystem>
#include <string>

#include "mapping/layers/layer_types.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Table of a map file with the map as it was without the edits of a person. Gone after any other
/// change of the map itself (`MapUpdate::write_map`).
inline constexpr const char* kBeforeTable = "map_before_edits";

/// A map as bytes: an SQLite file with the private tables of the map file, for copies of a map
/// within a map file. Equal maps have equal bytes.
[[nodiscard]] Bytes map_to_bytes(const Map& map);

/// Reads them back to the bit. Throws BadInput for damage, which names `file`.
[[nodiscard]] Map map_from_bytes(const Bytes& bytes, const std::filesystem::path& file);

}  // namespace roadbook
