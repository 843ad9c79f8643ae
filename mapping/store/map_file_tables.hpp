#pragma once

#include <map>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

// The private tables of the map file (docs/reference/map_file.md) <-> struct Map.

/// Raised with every change of the tables' layout; an older file is brought up to date or refused.
inline constexpr int kMapSchemaVersion = 2;

/// Creates the empty tables, replacing those that are there. Layers and other tables stay.
void create_map_tables(const SqlDatabase& database);

/// Adds what tables of schema version 1 lack. A file of this version stays as it is.
void migrate_map_tables(const SqlDatabase& database);

/// Fills the empty tables. Observations are stored by keyframe and camera, in the given order
/// within each; the map has passed `map_problems`.
void write_map_tables(const SqlDatabase& database, const Map& map);

/// Reads the tables, corners without a landmark only `with_corners`. Throws BadInput with table,
/// row and column of an invalid value.
[[nodiscard]] Map read_map_tables(const SqlDatabase& database, bool with_corners = true);

/// Reads the tables `sessions` and `session_places`.
[[nodiscard]] std::vector<Session> read_session_table(const SqlDatabase& database);

/// Names of the private tables, `map_meta` not among them.
[[nodiscard]] const std::vector<std::string>& map_table_names();

}  // namespace roadbook
