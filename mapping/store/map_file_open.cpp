#include "mapping/store/map_file_open.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <mutex>

#include "base/text.hpp"
#include "mapping/store/foreign_parts.hpp"
#include "mapping/store/map_file_disk.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {

void refuse_file(const std::filesystem::path& path,
                 const std::string& field,
                 const std::string& got,
                 const std::string& want) {
  throw BadInput(Problem{Severity::kError, path.string(), 0, field, got, want});
}

const std::filesystem::path& existing_map_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
    refuse_file(path, "map", "no such file", "a map file");
  if (error)
    throw StorageError(
        to_line({Severity::kError, path.string(), 0, "map", error.message(), "a readable file"}));
  if (!std::filesystem::is_regular_file(status))
    refuse_file(path, "map", "no regular file", "a map file");
  return path;
}

namespace {

void check_schema(const SqlDatabase& database) {
  const auto& path = database.file();
  if (database.value("SELECT count(*) FROM sqlite_master WHERE type='table' AND name='map_meta'") !=
      "1")
    refuse_file(path, "map_meta", "no such table", "a map written by roadbook");
  const std::string version = meta_value(database, "schema_version");
  const auto number = parse_int(version);
  if (!number || *number < 1)
    refuse_file(path, "schema_version", version.empty() ? "nothing" : version, "a number from 1");
  if (*number > kMapSchemaVersion)
    refuse_file(path, "schema_version", version + ", of a newer roadbook",
                "at most " + std::to_string(kMapSchemaVersion));
  const std::string state = meta_value(database, "state");
  if (state != "complete")
    refuse_file(path, "state", state.empty() ? "nothing" : state, "complete");
}

// Identifies the content of a file: device, inode, size, times of the last change.
using FileState = std::array<std::int64_t, 7>;

FileState state_of(const std::filesystem::path& path) {
  struct stat s {};
  if (::stat(path.c_str(), &s) != 0) return {};
  return {static_cast<std::int64_t>(s.st_dev),
          static_cast<std::int64_t>(s.st_ino),
          s.st_size,
          s.st_mtim.tv_sec,
          s.st_mtim.tv_nsec,
          s.st_ctim.tv_sec,
          s.st_ctim.tv_nsec};
}

// Files that this process has verified: a process that opens a map several times reads all of it
// once (0.7 s for 120 MB). As in Git's index, a file that has just been changed is not remembered:
// another change might carry the same time.
class RightFiles {
 public:
  [[nodiscard]] bool has(const FileState& state) {
    const std::lock_guard lock(mutex_);
    return std::find(states_.begin(), states_.end(), state) != states_.end();
  }
  void remember(const FileState& state) {
    constexpr std::int64_t kSettledS = 2;
    if (std::time(nullptr) - std::max(state[3], state[5]) < kSettledS) return;
    const std::lock_guard lock(mutex_);
    states_[next_++ % states_.size()] = state;
  }
  static RightFiles& of_process() {
    static RightFiles files;
    return files;
  }

 private:
  std::mutex mutex_;
  std::array<FileState, 16> states_{};
  std::size_t next_ = 0;
};

SqlDatabase open_existing(const std::filesystem::path& path, bool look_at_pages) {
  recover_database(existing_map_file(path));
  SqlDatabase database(path, SqlMode::kRead);
  refuse_foreign_parts(database);
  const std::string fault = look_at_pages ? database.value("PRAGMA quick_check(1)") : "ok";
  if (fault != "ok") refuse_file(path, "quick_check", fault, "ok");
  check_schema(database);
  return database;
}

}  // namespace

SqlDatabase open_map_file(const std::filesystem::path& path) { return open_existing(path, true); }

SqlDatabase open_verified(const std::filesystem::path& path) {
  const FileState state = state_of(path);
  const bool known = state != FileState{} && RightFiles::of_process().has(state);
  SqlDatabase database = open_existing(path, !known);
  if (known && state_of(path) == state) return database;
  (void)verified_digests(database);
  if (state_of(path) == state) RightFiles::of_process().remember(state);
  return database;
}

SqlDatabase open_registries(const std::filesystem::path& path) {
  const FileState state = state_of(path);
  const bool known = state != FileState{} && RightFiles::of_process().has(state);
  SqlDatabase database = open_existing(path, false);
  if (!known || state_of(path) != state) verify_registries(database);
  return database;
}

std::string meta_value(const SqlDatabase& database, const std::string& key) {
  SqlStatement row = database.prepare("SELECT value FROM map_meta WHERE key = ?");
  row.bind_text(1, key);
  return row.step() ? row.text(0) : std::string{};
}

void set_meta_value(const SqlDatabase& database, const std::string& key, const std::string& value) {
  database.prepare("DELETE FROM map_meta WHERE key = ?").bind_text(1, key).run();
  database.prepare("INSERT INTO map_meta(key, value) VALUES(?, ?)")
      .bind_text(1, key)
      .bind_text(2, value)
      .run();
}

void add_audit(const SqlDatabase& database, const std::string& action, const std::string& detail) {
  database.prepare("INSERT INTO audit(action, detail) VALUES(?, ?)")
      .bind_text(1, action)
      .bind_text(2, detail)
      .run();
}

std::int64_t newest_session_ns(const SqlDatabase& database) {
  SqlStatement row = database.prepare("SELECT max(t_end_ns) FROM sessions");
  return row.step() ? row.integer(0) : 0;
}

}  // namespace roadbook
