#include <algorithm>

#include "base/parallel.hpp"
#include "semantics/overhead/overhead_passes.hpp"

namespace roadbook {
namespace {

// Number of views that are read together: enough to keep all cores busy, few enough to limit the
// memory.
constexpr std::size_t kMaxBatch = 8;

struct Batch {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::set<TileIndex> tiles;
};

// Takes as many of the next views as fit. Their tiles together may take half of the tiles in
// memory.
Batch next_batch(const PlacedViews& placed, std::size_t begin, std::size_t max_tiles) {
  Batch batch{begin, begin, {}};
  while (batch.end < placed.tiles.size() && batch.end - begin < kMaxBatch) {
    std::set<TileIndex> with = batch.tiles;
    with.insert(placed.tiles[batch.end].begin(), placed.tiles[batch.end].end());
    if (batch.end > begin && with.size() > max_tiles) break;
    batch.tiles = std::move(with);
    ++batch.end;
  }
  return batch;
}

class Mosaic {
 public:
  Mosaic(const OverheadInput& input,
         const PlacedViews& placed,
         const std::vector<std::vector<double>>& gains,
         const OverheadOptions& options)
      : input_(input), placed_(placed), gains_(gains), options_(options) {}

  void read(const Batch& batch, ViewImages* views, MosaicCounts* counts) {
    images_.assign(batch.end - batch.begin, {});
    std::vector<std::pair<std::size_t, std::size_t>> wanted;
    for (std::size_t i = 0; i < images_.size(); ++i) {
      images_[i].resize(gains_[batch.begin + i].size());
      if (placed_.tiles[batch.begin + i].empty()) continue;
      for (std::size_t camera = 0; camera < images_[i].size(); ++camera)
        wanted.emplace_back(i, camera);
    }
    parallel_for(wanted.size(), options_.num_threads, [&](std::size_t n) {
      const auto [i, camera] = wanted[n];
      const std::size_t view = batch.begin + i;
      images_[i][camera] = make_mosaic_image(views->last(view, camera), gains_[view][camera]);
    });
    for (const auto& [i, camera] : wanted)
      ++(images_[i][camera].empty() ? counts->images_missing : counts->images_used);
  }

  // Every tile receives the views in driving order, so the number of threads does not change its
  // sums.
  void add_to(const Batch& batch, MosaicTile* tile) const {
    for (std::size_t view = batch.begin; view < batch.end; ++view) {
      if (!placed_.tiles[view].contains(tile->index())) continue;
      const int rig = input_.views[view].rig;
      const auto& cameras = input_.rigs[static_cast<std::size_t>(rig)].cameras;
      for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
        const GroundCamera eye(cameras[camera], mask_of(input_, rig, camera),
                               placed_.T_map_vehicle[view], options_);
        tile->add(images_[view - batch.begin][camera], eye, static_cast<std::uint32_t>(view),
                  options_.mode);
      }
    }
  }

 private:
  const OverheadInput& input_;
  const PlacedViews& placed_;
  const std::vector<std::vector<double>>& gains_;
  const OverheadOptions& options_;
  std::vector<std::vector<MosaicImage>> images_;
};

}  // namespace

MosaicCounts add_views(const OverheadInput& input,
                       const PlacedViews& placed,
                       const std::vector<std::vector<double>>& gains,
                       const OverheadOptions& options,
                       const Progress& progress,
                       ViewImages* images,
                       TileStore* store) {
  Mosaic mosaic(input, placed, gains, options);
  MosaicCounts counts;
  for (std::size_t begin = 0; begin < input.views.size();) {
    report(progress, "overhead", begin, input.views.size());
    const Batch batch = next_batch(placed, begin, store->max_resident() / 2);
    mosaic.read(batch, images, &counts);
    const std::vector<MosaicTile*> tiles = store->acquire(batch.tiles);
    parallel_for(tiles.size(), options.num_threads,
                 [&](std::size_t i) { mosaic.add_to(batch, tiles[i]); });
    begin = batch.end;
  }
  return counts;
}

}  // namespace roadbook
