#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "semantics/overhead/mosaic_tile.hpp"

namespace roadbook {

/// The tiles of a mosaic, of which only so many stay in memory: those unused for longest wait in a
/// scratch folder, which the store makes and removes. Not thread-safe; the tiles it gives are
/// independent of each other.
class TileStore {
 public:
  TileStore(std::filesystem::path scratch,
            std::size_t max_resident,
            double resolution_m,
            const GroundModel& ground);
  ~TileStore();
  TileStore(const TileStore&) = delete;
  TileStore& operator=(const TileStore&) = delete;

  /// Brings the tiles to memory, new ones empty, and lets others go if there are too many. The
  /// pointers hold until the next call. Throws StorageError.
  std::vector<MosaicTile*> acquire(const std::set<TileIndex>& indices);
  /// All tiles ever acquired, in order.
  [[nodiscard]] std::vector<TileIndex> indices() const;
  [[nodiscard]] std::size_t spilled() const { return spilled_; }
  [[nodiscard]] std::size_t max_resident() const { return max_resident_; }

 private:
  struct Slot {
    std::unique_ptr<MosaicTile> tile;  ///< null: in the scratch folder
    std::size_t used = 0;              ///< number of the last call that asked for it
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
