#pragma once

#include <map>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

// The private tables of the map file (docs/reference/map_file.md) <-> struct Map.

/// Raised with every change of the tables' layout; an older file is brought up to date or refused.
inline constexpr int kMapSchemaVersion = 1;

/// Creates the empty tables, replacing those that are there. Layers and other tables stay.
void create_map_tables(const SqlDatabase& database);

/// Fills the empty tables. Observations are stored by keyframe and camera, in the given order
/// within each; the map has passed `map_problems`.
void write_map_tables(const SqlDatabase& database, const Map& map);

/// Reads the tables. Throws BadInput with table, row and column of an invalid value.
[[nodiscard]] Map read_map_tables(const SqlDatabase& database);

/// Names of the private tables, `map_meta` not among them.
[[nodiscard]] const std::vector<std::string>& map_table_names();

}  // namespace roadbook
