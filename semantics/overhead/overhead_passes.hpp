#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "base/progress.hpp"
#include "semantics/overhead/ground_camera.hpp"
#include "semantics/overhead/overhead_input.hpp"
#include "semantics/overhead/overhead_options.hpp"
#include "semantics/overhead/tile_store.hpp"
#include "semantics/overhead/view_images.hpp"

namespace roadbook {

// The two passes over the images that make an overhead image: exposure, then mosaic.

/// Poses moved onto the ground, and the tiles in range of each view.
struct PlacedViews {
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<std::set<TileIndex>> tiles;
};
/// `options.max_range_m` must be set, here and in the functions below.
[[nodiscard]] PlacedViews place_views(const OverheadInput& input, const OverheadOptions& options);

/// Own-vehicle mask of a camera; empty if the input has none. Refers to `input`.
[[nodiscard]] CarMask mask_of(const OverheadInput& input, int rig, std::size_t camera);

/// gains[view][camera], estimated from ground near the vehicle that several images show.
[[nodiscard]] std::vector<std::vector<double>> balance_exposure(const OverheadInput& input,
                                                                const PlacedViews& placed,
                                                                const OverheadOptions& options,
                                                                const Progress& progress,
                                                                ViewImages* images);

struct MosaicCounts {
  std::size_t images_used = 0;
  std::size_t images_missing = 0;
};

/// Averages all images into the tiles of `store`, in driving order.
MosaicCounts add_views(const OverheadInput& input,
                       const PlacedViews& placed,
                       const std::vector<std::vector<double>>& gains,
                       const OverheadOptions& options,
                       const Progress& progress,
                       ViewImages* images,
                       TileStore* store);

}  // namespace roadbook
