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

void complete(const SqlDatabase& database) {
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
