#include "mapping/store/map_file_lock.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"
#include "base/files/lock_holder.hpp"
#include "mapping/store/map_file_disk.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {
namespace {

// Two processes that begin together: one of them may need a moment until it gives way.
constexpr int kWaitForLockMs = 1000;

[[noreturn]] void refuse_held(const std::filesystem::path& part, const std::string& holder) {
  std::filesystem::path map = part;
  map.replace_extension();  // MAP.part is the lock of MAP
  throw StorageError(to_line({Severity::kError, map.string(), 0, "lock",
                              "a map that " + holder + " is building or changing",
                              "the end of that process, then the same command again"}));
}

// The lock of this transaction stays until the connection closes. The exclusive mode must begin
// with the lock: two connections that only read in this mode would never give way to each other.
int take_lock(sqlite3* database) {
  return sqlite3_exec(database, "BEGIN EXCLUSIVE; PRAGMA locking_mode = EXCLUSIVE; COMMIT", nullptr,
                      nullptr, nullptr) &
         0xff;
}

void empty_database(const SqlDatabase& database) {
  sqlite3_db_config(database.handle(), SQLITE_DBCONFIG_RESET_DATABASE, 1, nullptr);
  database.run("VACUUM");
  sqlite3_db_config(database.handle(), SQLITE_DBCONFIG_RESET_DATABASE, 0, nullptr);
}

bool has_tables(const SqlDatabase& database) {
  return database.value("SELECT count(*) FROM sqlite_master") != "0";
}

}  // namespace

std::filesystem::path beside(const std::filesystem::path& map, const char* suffix) {
  return linked_file(map) += suffix;
}

/// MAP.part, open and locked.
struct HeldMap {
  explicit HeldMap(const std::filesystem::path& part) : database(part, SqlMode::kCreate) {
    sqlite3_busy_timeout(database.handle(), kWaitForLockMs);
    int code = take_lock(database.handle());
    if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT) {
      was_damaged = true;
      empty_database(database);
      code = take_lock(database.handle());
    }
    if (code == SQLITE_BUSY) refuse_held(part, lock_holder(part));
    if (code != SQLITE_OK)
      throw StorageError(to_line(
          {Severity::kError, part.string(), 0, "lock",
           code == SQLITE_FULL ? write_fault(part, ENOSPC) : sqlite3_errmsg(database.handle()),
           "a writable folder"}));
  }
  ~HeldMap() {
    try {
      if (!has_moved() && (is_done || !has_tables(database))) remove_database(database.file());
    } catch (const Error&) {
      // The remaining file is no map and does no harm; a destructor cannot report.
    }
  }
  HeldMap(const HeldMap&) = delete;
  HeldMap& operator=(const HeldMap&) = delete;

  /// The holder before may have removed the file between its opening and its locking here.
  [[nodiscard]] bool has_moved() const {
    int moved = 0;
    sqlite3_file_control(database.handle(), "main", SQLITE_FCNTL_HAS_MOVED, &moved);
    return moved != 0;
  }

  SqlDatabase database;
  bool was_damaged = false;
  bool is_done = false;  ///< its checkpoints are in the map
  bool in_work = false;  ///< a MapLock uses it; guarded by the list's mutex
};

namespace {

std::shared_ptr<HeldMap> lock_part(const std::filesystem::path& part) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    auto held = std::make_shared<HeldMap>(part);
    if (!held->has_moved()) return held;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  refuse_held(part, "another process");
}

/// The maps that this process holds, by the path of MAP.part.
class HeldMaps {
 public:
  std::shared_ptr<HeldMap> hold(const std::filesystem::path& map, bool for_work) {
    const std::filesystem::path part = beside(map, ".part");
    // A forked process does not hold what its parent holds.
    const std::string key =
        std::to_string(getpid()) + " " +
        std::filesystem::weakly_canonical(std::filesystem::absolute(part)).string();
    const std::lock_guard lock(mutex_);
    std::shared_ptr<HeldMap> held = maps_[key].lock();
    if (held && for_work && held->in_work) refuse_held(part, "this process");
    if (!held) {
      held = lock_part(part);
      maps_[key] = held;
    }
    if (!for_work) return held;
    if (held->is_done) empty_database(held->database);
    held->is_done = false;
    held->in_work = true;
    return held;
  }
  /// Ends the use of a map; the last one unlocks it.
  void release(std::shared_ptr<HeldMap> held, bool of_work) {
    const std::lock_guard lock(mutex_);
    if (of_work) held->in_work = false;
    held.reset();
    std::erase_if(maps_, [](const auto& entry) { return entry.second.expired(); });
  }
  static HeldMaps& of_process() {
    static HeldMaps maps;
    return maps;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<HeldMap>> maps_;
};

}  // namespace

MapHold::MapHold(const std::filesystem::path& map)
    : held_(HeldMaps::of_process().hold(map, false)) {}
MapHold::~MapHold() { HeldMaps::of_process().release(std::move(held_), false); }

std::string MapHold::waiting_build() const {
  try {
    if (!has_tables(held_->database)) return {};
    return held_->database.value("SELECT inputs_key FROM build");
  } catch (const BadInput&) {
    return {};  // damaged: the next build starts afresh
  }
}

void MapHold::remove_checkpoints() const { held_->is_done = true; }

MapLock::MapLock(const std::filesystem::path& map)
    : held_(HeldMaps::of_process().hold(map, true)) {}
MapLock::~MapLock() { HeldMaps::of_process().release(std::move(held_), true); }

const SqlDatabase& MapLock::database() const { return held_->database; }
bool MapLock::was_damaged() const { return held_->was_damaged; }
void MapLock::remove_file() const { held_->is_done = true; }
void MapLock::reset() const { empty_database(held_->database); }

}  // namespace roadbook
