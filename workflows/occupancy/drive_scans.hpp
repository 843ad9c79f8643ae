#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/occupancy/scans.hpp"

namespace roadbook {

/// T_map_vehicle at a stamp; empty where the map has no pose.
using PoseAt = std::function<std::optional<Eigen::Isometry3d>(std::int64_t t_ns)>;

struct DriveScans {
  std::vector<RangeScan> scans;  ///< with a pose
  std::size_t without_pose = 0;  ///< scans
  RangeModel model;              ///< of range0
};

/// Reads `range0` of a drive as scans in the map's plane. Beams that a tilted car points up or down
/// are shortened to their horizontal part. Throws BadInput, with file and line, for readings that
/// are not finite, negative or beyond the maximum range, and for beams that sensor.yaml does not
/// list; also for a drive without range0, or without `beam_azimuths`.
[[nodiscard]] DriveScans read_drive_scans(const Drive& drive, const PoseAt& pose_at);

}  // namespace roadbook
