#pragma once

#include <filesystem>
#include <vector>

#include "base/messages.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"
#include "mapping/occupancy/build_patches.hpp"
#include "mapping/occupancy/place_patches.hpp"
#include "workflows/occupancy/drive_scans.hpp"

namespace roadbook {

/// The poses of a drive in a map.
struct DrivePoses {
  PoseAt at;
  bool localised = false;  ///< the drive is no session of the map
  int session = -1;        ///< of the map; -1: none

  /// For each scan the number of the keyframe on which its patch may hang: of the session the
  /// nearest in time, otherwise the nearest in place.
  [[nodiscard]] std::vector<std::size_t> anchors_of(const std::vector<RangeScan>& scans,
                                                    const Map& map) const;
};

/// Poses of the session that was made of the drive (its digest is equal); otherwise the drive is
/// localised in the map, and poses between two frames, at most 0.5 s apart, are interpolated. The
/// map must outlive the result. Throws the exceptions of `localise_in_map`.
[[nodiscard]] DrivePoses drive_poses(const Drive& drive,
                                     const Map& map,
                                     const std::filesystem::path& map_file,
                                     int num_threads,
                                     Messages& messages);

/// T_map_vehicle in the plane for keyframes of a map, by session name and stamp.
[[nodiscard]] PoseOfKeyframe keyframe_poses(const Map& map);

/// All keyframes of a map, in their order.
[[nodiscard]] std::vector<PatchAnchor> patch_anchors(const Map& map);

}  // namespace roadbook
