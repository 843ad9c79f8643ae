#include "mapping/store/map_file_lock.hpp"

#include "base/error.hpp"
#include "mapping/store/map_file_disk.hpp"

namespace roadbook {
namespace {

[[noreturn]] void refuse_busy(const std::filesystem::path& file) {
  throw StorageError(
      to_line({Severity::kError, file.string(), 0, "lock",
               "a map that another process is building or changing", "one process at a time"}));
}

}  // namespace

std::filesystem::path beside(std::filesystem::path map, const char* suffix) {
  return map += suffix;
}

MapLock::MapLock(const std::filesystem::path& map)
    : database_(beside(map, ".part"), SqlMode::kCreate) {
  sqlite3* const handle = database_.handle();
  sqlite3_busy_timeout(handle, 0);
  // In exclusive mode the lock of the first transaction stays until the connection closes.
  database_.run("PRAGMA locking_mode = EXCLUSIVE");
  const auto lock = [&] {
    return sqlite3_exec(handle, "BEGIN EXCLUSIVE; COMMIT", nullptr, nullptr, nullptr) & 0xff;
  };
  int code = lock();
  if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT) {
    was_damaged_ = true;
    reset();
    code = lock();
  }
  if (code == SQLITE_BUSY) refuse_busy(database_.file());
  if (code != SQLITE_OK)
    throw StorageError(to_line({Severity::kError, database_.file().string(), 0, "lock",
                                sqlite3_errmsg(handle), "a writable folder"}));
  // The holder before us may have finished and removed the file between our opening and locking it.
  int moved = 0;
  sqlite3_file_control(handle, "main", SQLITE_FCNTL_HAS_MOVED, &moved);
  if (moved != 0) refuse_busy(database_.file());
}

void MapLock::remove_file() const { remove_database(database_.file()); }

void MapLock::reset() const {
  sqlite3_db_config(database_.handle(), SQLITE_DBCONFIG_RESET_DATABASE, 1, nullptr);
  database_.run("VACUUM");
  sqlite3_db_config(database_.handle(), SQLITE_DBCONFIG_RESET_DATABASE, 0, nullptr);
}

}  // namespace roadbook
