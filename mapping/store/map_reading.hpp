#pragma once

#include <filesystem>

namespace roadbook {

/// A read of a map in several steps, without a lock: others may change the map meanwhile. The
/// reader asks at the end whether all steps have read one map.
class MapReading {
 public:
  /// Throws BadInput without a map, StorageError if it cannot be read.
  explicit MapReading(std::filesystem::path map);
  ~MapReading();
  MapReading(const MapReading&) = delete;
  MapReading& operator=(const MapReading&) = delete;

  /// Throws StorageError if another file has taken the map's place since the construction. Events
  /// that were added to the map do not count.
  void require_same_map() const;

 private:
  std::filesystem::path map_;
  int descriptor_ = -1;  ///< keeps the file, so that its inode is not given to another one
};

}  // namespace roadbook
