#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

// Content digests: SQLite has no checksums, and a flipped bit passes its own checks more often than
// not. Every table has a digest over its rows, in the order of their keys, whatever page they are
// on.

struct MapDigests {
  std::map<std::string, std::string> tables;
  std::string schema;  ///< of all CREATE statements
  /// Of the content of the map, without paths on this machine: all tables except session_places,
  /// and without the keys of map_meta that begin with "place.".
  std::string content;
};

/// Digests of the present content of the file. An R-tree counts by its entries for the content. The
/// tables of its nodes have digests of their own, as their layout depends on the file's history.
[[nodiscard]] MapDigests compute_digests(const SqlDatabase& database);

/// Writes `digests` to `map_meta` (keys `digest`, `schema_digest`, `digest.TABLE`), replacing
/// older.
void store_digests(const SqlDatabase& database, const MapDigests& digests);

/// Whether a file and its copy, which has `digests`, have the same content. GeoPackage's own tables
/// list the layers in the order in which they were written; here the order does not count. Compares
/// also what does not belong to the content digest: places on this machine.
[[nodiscard]] bool have_same_content(const SqlDatabase& file,
                                     const SqlDatabase& copy,
                                     const MapDigests& digests);

/// Digests of one table and of the content, after a change of that table alone; the others' are
/// taken as stored. The digest of the file's bytes is dropped.
void renew_table_digest(const SqlDatabase& database, const std::string& table);

/// Tables `..._events` only grow, each row with the digest of all rows before it (MapEventLog): the
/// last row covers them.
[[nodiscard]] bool is_event_table(std::string_view table);

/// Compares the stored digests with those of the content, and returns the latter. Throws BadInput
/// at the first digest that is missing, superfluous or wrong: the rest of a damaged file is not
/// read.
[[nodiscard]] MapDigests verified_digests(const SqlDatabase& database);

/// Compares the digest of the CREATE statements, that of the content with the stored digests of
/// tables, and those of `map_meta` and of GeoPackage's tables, which say what the file holds. Rows
/// of other tables are not read. Throws BadInput as verified_digests does.
void verify_registries(const SqlDatabase& database);

/// Compares the digest of one table, with which its rows are as they were stored, and its indices
/// with the rows. Throws BadInput.
void verify_table(const SqlDatabase& database, const std::string& table);

}  // namespace roadbook
