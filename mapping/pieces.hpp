#pragma once

#include <filesystem>

#include "mapping/map.hpp"

namespace roadbook {

/// Key of `map_meta` with the number of pieces; maps of one piece may lack it.
inline constexpr const char* kPiecesKey = "pieces";

/// Number of pieces of the map; 1 for a map whose poses are all joined.
[[nodiscard]] int piece_count(const Map& map);

/// Throws Refused if the map in `file` has several pieces (`map --apart`): its poses have no common
/// place. Reads the meta table alone.
void require_one_piece(const std::filesystem::path& file);

/// The map in `file`, whose poses have one common place. Throws Refused for a map of several pieces
/// (`map --apart`), and the exceptions of `load_map`.
[[nodiscard]] Map load_joined_map(const std::filesystem::path& file);

}  // namespace roadbook
