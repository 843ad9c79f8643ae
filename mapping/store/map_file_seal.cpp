#include "mapping/store/map_file_seal.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "mapping/layers/layer_styles.hpp"
#include "mapping/layers/map_layers_vector.hpp"
#include "mapping/store/file_digest.hpp"
#include "mapping/store/map_file_digest.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {
namespace {

bool has_table_of(const SqlDatabase& database, const char* table) {
  SqlStatement row =
      database.prepare("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?");
  row.bind_text(1, table);
  return row.step() && row.integer(0) == 1;
}

// Gives the rows of `ordered` (a query of ids) the ids 1, 2, ... in `table` and in the column that
// refers to it. Two steps, because ids are unique.
void renumber(const SqlDatabase& database,
              const std::string& table,
              const std::string& ordered,
              const std::string& reference = "") {
  std::vector<std::int64_t> ids;
  SqlStatement rows = database.prepare(ordered);
  while (rows.step()) ids.push_back(rows.integer(0));
  std::vector<std::string> updates{"UPDATE " + table + " SET id = ? WHERE id = ?"};
  if (!reference.empty())
    updates.push_back("UPDATE gpkg_metadata_reference SET " + reference + " = ? WHERE " +
                      reference + " = ?");
  for (const std::string& sql : updates) {
    SqlStatement update = database.prepare(sql);
    for (std::size_t i = 0; i < ids.size(); ++i)
      update.bind(1, -static_cast<std::int64_t>(i + 1)).bind(2, ids[i]).run();
    for (std::size_t i = 1; i <= ids.size(); ++i)
      update.bind(1, static_cast<std::int64_t>(i)).bind(2, -static_cast<std::int64_t>(i)).run();
  }
}

// GDAL numbers what belongs to rasters in the order of writing. The order of the names instead does
// not depend on the history of the file: the same verb twice gives the same content.
void order_raster_ids(const SqlDatabase& database) {
  if (has_table_of(database, "gpkg_2d_gridded_coverage_ancillary"))
    renumber(database, "gpkg_2d_gridded_coverage_ancillary",
             "SELECT id FROM gpkg_2d_gridded_coverage_ancillary ORDER BY tile_matrix_set_name");
  if (has_table_of(database, "gpkg_2d_gridded_tile_ancillary"))
    renumber(database, "gpkg_2d_gridded_tile_ancillary",
             "SELECT id FROM gpkg_2d_gridded_tile_ancillary ORDER BY tpudt_name, tpudt_id");
  if (has_table_of(database, "gpkg_metadata_reference"))
    renumber(database, "gpkg_metadata",
             "SELECT m.id FROM gpkg_metadata m LEFT JOIN gpkg_metadata_reference r "
             "ON r.md_file_id = m.id GROUP BY m.id ORDER BY min(r.table_name), m.id",
             "md_file_id");
}

void complete(const SqlDatabase& database) {
  migrate_map_tables(database);
  order_raster_ids(database);
  unite_map_frames(database);
  write_layer_styles(database, utc_text(newest_session_ns(database)));
  set_meta_value(database, "schema_version", std::to_string(kMapSchemaVersion));
  set_meta_value(database, "state", "complete");
}

void refuse_bad_pages(const SqlDatabase& database) {
  const std::string fault = database.value("PRAGMA quick_check(1)");
  if (fault != "ok")
    throw StorageError(
        to_line({Severity::kError, database.file().string(), 0, "quick_check", fault, "ok"}));
}

}  // namespace

void seal_map_file(const std::filesystem::path& path) {
  {
    const SqlDatabase database(path, SqlMode::kReadWrite);
    SqlTransaction transaction(database);
    complete(database);
    store_digests(database, compute_digests(database));
    reserve_file_digest(database);
    transaction.commit();
    refuse_bad_pages(database);
  }
  write_file_digest(path);
}

bool seal_changed_copy(const std::filesystem::path& copy,
                       const std::filesystem::path& map,
                       const std::vector<AuditLine>& lines) {
  {
    const SqlDatabase database(copy, SqlMode::kReadWrite);
    SqlTransaction transaction(database);
    complete(database);
    const MapDigests digests = compute_digests(database);
    if (have_same_content(open_verified(map), database, digests)) return false;
    store_digests(database, digests);
    for (const auto& [action, detail] : lines) add_audit(database, action, detail);
    renew_table_digest(database, "audit");
    reserve_file_digest(database);
    transaction.commit();
    refuse_bad_pages(database);
  }
  write_file_digest(copy);
  return true;
}

}  // namespace roadbook
