#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace roadbook {

class SqlDatabase;
struct HeldMap;

// The lock of a map is SQLite's own on MAP.part: a killed process leaves none behind, and the file
// holds the checkpoints of a build. A symbolic link has the lock of the map that it names.

/// Holds the lock of a map for as long as the object lives: at most one process builds or changes a
/// map. A workflow takes the hold before it reads the map, so that what it has read is still true
/// when it writes. A MapUpdate, MapFileBuilder or MapEventLog of the same process works under the
/// hold, one at a time. Safe to use from several threads.
class MapHold {
 public:
  /// Waits up to a second. Throws StorageError that names the process that holds the lock.
  explicit MapHold(const std::filesystem::path& map);
  ~MapHold();
  MapHold(const MapHold&) = delete;
  MapHold& operator=(const MapHold&) = delete;

  /// The inputs key of the build that waits in MAP.part; empty without one.
  [[nodiscard]] std::string waiting_build() const;
  /// Drops the checkpoints that wait in MAP.part.
  void remove_checkpoints() const;

 private:
  std::shared_ptr<HeldMap> held_;
};

/// The lock of the one object that changes a map at a time. Works under a MapHold of this process,
/// or takes the lock itself.
class MapLock {
 public:
  /// Throws StorageError where another process, or another object of this one, changes the map.
  explicit MapLock(const std::filesystem::path& map);
  ~MapLock();
  MapLock(const MapLock&) = delete;
  MapLock& operator=(const MapLock&) = delete;

  /// MAP.part. The end of the lock removes it, unless it holds the checkpoints of a build.
  [[nodiscard]] const SqlDatabase& database() const;
  /// A file that was no database, or a damaged one, has been emptied on opening.
  [[nodiscard]] bool was_damaged() const;
  /// Removes MAP.part with all checkpoints at the end of the lock.
  void remove_file() const;
  /// Empties MAP.part.
  void reset() const;

 private:
  std::shared_ptr<HeldMap> held_;
};

/// MAP with a suffix: MAP.part, MAP.new. They lie beside the file that a symbolic link names.
[[nodiscard]] std::filesystem::path beside(const std::filesystem::path& map, const char* suffix);

}  // namespace roadbook
