#pragma once

#include <filesystem>

namespace roadbook {

/// A new state of a map, made beside it in several steps and put into its place when it is whole.
/// Without `put_in_place` it is removed, and the map stays as it was.
class MapCopy {
 public:
  /// The file to work on is MAP with `suffix`; it does not exist yet. `map` is held by the caller.
  MapCopy(std::filesystem::path map, const char* suffix);
  ~MapCopy();
  MapCopy(const MapCopy&) = delete;
  MapCopy& operator=(const MapCopy&) = delete;

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Copies the map to `file()`. Throws StorageError.
  void begin_with_map() const;
  /// Renames `file()` over the map. Throws StorageError.
  void put_in_place();

 private:
  void remove_files() const;

  std::filesystem::path map_;
  std::filesystem::path file_;
};

}  // namespace roadbook
