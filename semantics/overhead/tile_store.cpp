#include "semantics/overhead/tile_store.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include "base/error.hpp"

namespace roadbook {

TileStore::TileStore(std::filesystem::path scratch,
                     std::size_t max_resident,
                     double resolution_m,
                     const GroundModel& ground)
    : scratch_(std::move(scratch)),
      max_resident_(max_resident),
      resolution_m_(resolution_m),
      ground_(&ground) {
  std::error_code error;
  std::filesystem::remove_all(scratch_, error);  // left by a run that was killed
  std::filesystem::create_directories(scratch_, error);
  if (error)
    throw StorageError("error: " + scratch_.string() + ": folder: got " + error.message() +
                       ", want one to write to");
}

TileStore::~TileStore() {
  std::error_code ignored;
  std::filesystem::remove_all(scratch_, ignored);
}

std::filesystem::path TileStore::file_of(TileIndex index) const {
  return scratch_ / ("tile_" + std::to_string(index.row) + "_" + std::to_string(index.column));
}

void TileStore::make_room(std::size_t wanted, const std::set<TileIndex>& keep) {
  if (resident_ + wanted <= max_resident_) return;
  std::vector<std::pair<std::size_t, TileIndex>> candidates;
  for (const auto& [index, slot] : slots_)
    if (slot.tile && !keep.contains(index)) candidates.emplace_back(slot.used, index);
  std::ranges::sort(candidates);
  for (const auto& [used, index] : candidates) {
    if (resident_ + wanted <= max_resident_) return;
    Slot& slot = slots_[index];
    slot.tile->save(file_of(index));
    slot.tile.reset();
    --resident_;
    ++spilled_;
  }
}

std::vector<MosaicTile*> TileStore::acquire(const std::set<TileIndex>& indices) {
  ++calls_;
  std::size_t missing = 0;
  for (const TileIndex index : indices) {
    const auto it = slots_.find(index);
    if (it == slots_.end() || !it->second.tile) ++missing;
  }
  make_room(missing, indices);
  std::vector<MosaicTile*> tiles;
  for (const TileIndex index : indices) {
    const auto [it, is_new] = slots_.try_emplace(index);
    Slot& slot = it->second;
    if (!slot.tile) {
      slot.tile = std::make_unique<MosaicTile>(index, resolution_m_, *ground_);
      if (!is_new) slot.tile->load(file_of(index));
      ++resident_;
    }
    slot.used = calls_;
    tiles.push_back(slot.tile.get());
  }
  return tiles;
}

std::vector<TileIndex> TileStore::indices() const {
  std::vector<TileIndex> all;
  for (const auto& [index, slot] : slots_) all.push_back(index);
  return all;
}

}  // namespace roadbook
