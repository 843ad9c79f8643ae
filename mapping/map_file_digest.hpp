#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "mapping/map_file_sqlite.hpp"

namespace roadbook {

// Content digests: SQLite has no checksums, and a flipped bit passes its own checks more often than
// not. Every table has a digest over its rows, in the order of their keys, whatever page they are
// on.

struct MapDigests {
  std::map<std::string, std::string> tables;
  std::string schema;  ///< of all CREATE statements
  /// Of the map's content: tables but for where things lie on this machine (table
  /// `session_places`, keys `place.*` of `map_meta`).
  std::string content;
};

/// Digests of the file as it is. R-trees are taken by their entries, not by their nodes.
[[nodiscard]] MapDigests compute_digests(const SqlDatabase& database);

/// Writes `digests` to `map_meta` (keys `digest`, `schema_digest`, `digest.TABLE`), replacing
/// older.
void store_digests(const SqlDatabase& database, const MapDigests& digests);

/// One problem for each digest that is missing, left over or wrong.
[[nodiscard]] std::vector<Problem> compare_digests(const SqlDatabase& database,
                                                   const MapDigests& digests);

}  // namespace roadbook
