#pragma once

#include <span>
#include <string>
#include <vector>

#include "mapping/occupancy/occupancy_patch.hpp"
#include "mapping/occupancy/patch_grid.hpp"
#include "mapping/occupancy/scans.hpp"
#include "sensors/range/inverse_range.hpp"

namespace roadbook {

/// The rule for cells: log odds; the ratio form of the Bayes filter, which gives the same numbers;
/// the naive rule, a demonstration.
enum class OccupancyUpdate { kLogOdds, kBayes, kNaive };

struct BuildPatchesOptions {
  double cell_m = 0.1;
  double patch_m = 6.0;   ///< distance driven within one patch [m]
  double cone_rad = 0.0;  ///< full angle of a wide beam; 0: a ray
  OccupancyUpdate update = OccupancyUpdate::kLogOdds;
  int num_threads = 0;

  /// Throws InvalidOption.
  void check() const;
};

/// A keyframe on which a patch may hang.
struct PatchAnchor {
  std::string session;
  std::int64_t t_ns = 0;
  PlanePose map_vehicle;  ///< T_map_vehicle
};

struct BuiltPatches {
  std::vector<OccupancyPatch> patches;
  std::size_t updates = 0;  ///< changes of cells
};

/// The part of a grid that readings changed, as a patch of the map's frame without a pose; without
/// cells if nothing changed.
[[nodiscard]] OccupancyPatch cropped_patch(const PatchGrid& grid);
/// Stores a patch relative to the pose of a keyframe.
void hang_on(const PatchAnchor& anchor, OccupancyPatch& patch);

/// The readings of a drive as patches. Scans are grouped along the way; each group belongs to
/// the anchor of its middle scan. `anchor_of[i]`: index in `anchors` of the anchor nearest to scan
/// i. Patches are aligned with the cells of the map, so that they are drawn without resampling
/// until the map moves. The result does not depend on the number of threads. Throws InvalidOption.
[[nodiscard]] BuiltPatches build_patches(std::span<const RangeScan> scans,
                                         std::span<const std::size_t> anchor_of,
                                         const std::vector<PatchAnchor>& anchors,
                                         const std::string& drive,
                                         const InverseRangeModel& inverse,
                                         const BuildPatchesOptions& options);

}  // namespace roadbook
