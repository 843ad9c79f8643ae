#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "semantics/overhead/mosaic_tile.hpp"

namespace roadbook {

/// Tiles of a mosaic with a limit on memory: the least recently used tiles are moved to a scratch
/// folder, which the store creates and removes. Not thread-safe; the tiles that it returns may be
/// used in parallel.
class TileStore {
 public:
  TileStore(std::filesystem::path scratch,
            std::size_t max_resident,
            double resolution_m,
            const GroundModel& ground);
  ~TileStore();
  TileStore(const TileStore&) = delete;
  TileStore& operator=(const TileStore&) = delete;

  /// Loads or creates the tiles and moves others to the scratch folder if there are too many. The
  /// pointers are valid until the next call. Throws StorageError.
  std::vector<MosaicTile*> acquire(const std::set<TileIndex>& indices);
  /// Indices of all tiles acquired so far, in order.
  [[nodiscard]] std::vector<TileIndex> indices() const;
  [[nodiscard]] std::size_t spilled() const { return spilled_; }
  [[nodiscard]] std::size_t max_resident() const { return max_resident_; }

 private:
  struct Slot {
    std::unique_ptr<MosaicTile> tile;  ///< null: in the scratch folder
    std::size_t used = 0;              ///< number of the last call that acquired it
  };
  [[nodiscard]] std::filesystem::path file_of(TileIndex index) const;
  void make_room(std::size_t wanted, const std::set<TileIndex>& keep);

  std::filesystem::path scratch_;
  std::size_t max_resident_;
  double resolution_m_;
  const GroundModel* ground_;
  std::map<TileIndex, Slot> slots_;
  std::size_t resident_ = 0;
  std::size_t calls_ = 0;
  std::size_t spilled_ = 0;
};

}  // namespace roadbook
