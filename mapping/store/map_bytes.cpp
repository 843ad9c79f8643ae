#include "mapping/store/map_bytes.hpp"

#include "base/error.hpp"
#include "mapping/store/foreign_parts.hpp"
#include "mapping/store/map_file_sqlite.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {

Bytes map_to_bytes(const Map& map) {
  const SqlDatabase database(":memory:", SqlMode::kCreate);
  SqlTransaction transaction(database);
  create_map_tables(database);
  write_map_tables(database, map);
  transaction.commit();
  sqlite3_int64 size = 0;
  unsigned char* data = sqlite3_serialize(database.handle(), "main", &size, 0);
  if (data == nullptr)
    throw StorageError("error: copy of the map: got no memory, want room for it");
  Bytes bytes(data, data + size);
  sqlite3_free(data);
  return bytes;
}

Map map_from_bytes(const Bytes& bytes, const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& got) {
    throw BadInput({Severity::kError, file.string(), 0, "copy of the map", got, "a whole copy"});
  };
  Bytes copy = bytes;  // must outlive the database
  const SqlDatabase database(":memory:", SqlMode::kCreate);
  const auto size = static_cast<sqlite3_int64>(copy.size());
  if (copy.empty() || sqlite3_deserialize(database.handle(), "main", copy.data(), size, size,
                                          SQLITE_DESERIALIZE_READONLY) != SQLITE_OK)
    refuse("no database");
  try {
    if (database.value("PRAGMA quick_check(1)") != "ok") refuse("damaged pages");
    refuse_foreign_parts(database);
    return read_map_tables(database);
  } catch (const BadInput& bad) {
    refuse(bad.problems().front().got);
  }
  return {};
}

}  // namespace roadbook
