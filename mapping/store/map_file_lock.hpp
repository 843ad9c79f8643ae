#pragma once

#include <filesystem>

#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

/// MAP.part, locked for as long as the object lives: at most one process builds or changes a map.
///
/// The lock is SQLite's own on that file, so a killed process leaves none behind.
class MapLock {
 public:
  /// Throws StorageError where another process holds the lock.
  explicit MapLock(const std::filesystem::path& map);

  [[nodiscard]] const SqlDatabase& database() const { return database_; }
  /// A file that was no database, or a damaged one, has been emptied on opening.
  [[nodiscard]] bool was_damaged() const { return was_damaged_; }
  /// Removes MAP.part; the lock ends with the object.
  void remove_file() const;
  /// Empties MAP.part.
  void reset() const;

 private:
  SqlDatabase database_;
  bool was_damaged_ = false;
};

/// MAP with a suffix: MAP.part, MAP.new.
[[nodiscard]] std::filesystem::path beside(std::filesystem::path map, const char* suffix);

}  // namespace roadbook
