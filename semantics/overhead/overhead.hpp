#pragma once

#include <filesystem>
#include <vector>

#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"
#include "semantics/overhead/overhead_input.hpp"
#include "semantics/overhead/overhead_options.hpp"
#include "semantics/overhead/overhead_summary.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

// Synthetic overhead image: a top view of the ground, made from the camera images. Source:
// [metric-semantic maps, section V-A.1]. Method and files: docs/guide/overhead.md.
//
// The paper rectifies the fisheye images first. An image of 180 degrees cannot be rectified to a
// pinhole image, so each ground pixel is projected directly through the camera model.

/// How far ground is taken from cameras of these rigs: 8 m, or half as far again as the nearest
/// ground that every camera sees, where a camera looks ahead over a near blind area (at most 100).
[[nodiscard]] double range_of_rigs(const std::vector<Rig>& rigs);

/// Makes the overhead image of `input` in folder `out` (created if missing; files are replaced).
///
/// Memory is bounded by `options.memory_mb` plus one small batch of images, for any size of map.
/// Equal input and options give equal bytes for any number of threads. Throws InvalidOption;
/// BadInput for views that do not match their rig; Refused if no ground pixel is observed;
/// StorageError; Interrupted.
OverheadSummary make_overhead(const OverheadInput& input,
                              const std::filesystem::path& out,
                              const OverheadOptions& options = {},
                              const Progress& progress = {});

/// Same for a map: the ground is estimated from the map, images are read from `drives` (one per
/// session; a null pointer leaves out the session).
OverheadSummary make_overhead(const Map& map,
                              const std::vector<const Drive*>& drives,
                              const std::filesystem::path& out,
                              const OverheadOptions& options = {},
                              const Progress& progress = {});

/// Views, rigs, own-vehicle masks and ground of a map, as the second make_overhead uses them. The
/// result refers to `drives`.
[[nodiscard]] OverheadInput overhead_input(const Map& map,
                                           const std::vector<const Drive*>& drives,
                                           const OverheadOptions& options = {});

}  // namespace roadbook
