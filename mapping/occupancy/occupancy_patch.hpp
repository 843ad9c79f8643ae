#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace roadbook {

/// A pose in the plane: a vehicle pose seen from above.
struct PlanePose {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;

  [[nodiscard]] Eigen::Isometry2d isometry() const {
    Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
    T.linear() = Eigen::Rotation2Dd(heading_rad).toRotationMatrix();
    T.translation() = Eigen::Vector2d(x_m, y_m);
    return T;
  }
};
[[nodiscard]] inline PlanePose plane_pose(const Eigen::Isometry2d& T) {
  return {T.translation().x(), T.translation().y(), std::atan2(T(1, 0), T(0, 0))};
}
[[nodiscard]] inline PlanePose plane_pose(const Eigen::Isometry3d& T) {
  return {T.translation().x(), T.translation().y(), std::atan2(T(1, 0), T(0, 0))};
}

/// A part of the occupancy grid, stored relative to a vehicle pose of the map. If the map moves the
/// pose, the patch moves with it. Row 0 has the least y of the patch's frame.
struct OccupancyPatch {
  std::string session;        ///< of the pose
  std::int64_t t_ns = 0;      ///< stamp of the pose, a keyframe
  std::string drive;          ///< name of the drive whose readings it holds
  std::int64_t begin_ns = 0;  ///< stamp of its first scan
  std::int64_t end_ns = 0;    ///< stamp of its last scan
  PlanePose vehicle_patch;    ///< T_vehicle_patch: the patch's frame in the frame of the vehicle
  PlanePose placed;           ///< T_map_patch where the patch was drawn last
  double cell_m = 0.1;
  int columns = 0;
  int rows = 0;
  std::vector<std::int16_t> log_odds;  ///< change since before any reading, in 1/1000
  std::vector<std::uint16_t> seen;     ///< readings that changed the cell
  std::vector<std::uint16_t> hits;     ///< readings that ended in the cell
  std::vector<std::uint16_t> ends;     ///< `packed_end` of their mean; 0: the middle

  /// Mean place of the readings that ended in a cell [cells, patch]; the cell's middle without any.
  [[nodiscard]] Eigen::Vector2d end_in(int column, int row, std::size_t cell) const {
    const Eigen::Vector2d middle(column + 0.5, row + 0.5);
    const int packed = ends.empty() ? 0 : ends[cell];
    if (packed == 0) return middle;
    return middle + Eigen::Vector2d((packed & 0xFF) - 128, (packed >> 8) - 128) / 256.0;
  }
};

/// A place in a cell, from its middle [cells, -0.5 to 0.5], as two bytes: 128 + 256 times the place
/// along the columns, then along the rows.
[[nodiscard]] inline std::uint16_t packed_end(const Eigen::Vector2d& from_middle) {
  const auto byte = [](double part) {
    return static_cast<unsigned>(std::clamp(std::lround(128.0 + 256.0 * part), 1L, 255L));
  };
  return static_cast<std::uint16_t>(byte(from_middle.x()) | byte(from_middle.y()) << 8U);
}

/// Unit of `OccupancyPatch::log_odds`.
inline constexpr double kLogOddsUnit = 1e-3;

}  // namespace roadbook
