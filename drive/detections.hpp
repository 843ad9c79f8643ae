#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace roadbook {

// The results of a people detector for a drive: the detected people, and the times of detection.
// They are the tables of `detector0/` (docs/reference/drive_format.md); `roadbook detect` keeps the
// same in the map.

/// A detected person, in the frame of the vehicle. The position stays right when the map is
/// optimised again.
struct Detection {
  std::int64_t t_ns = 0;
  double x_m = 0.0;  ///< of the feet, ahead of the rear axle
  double y_m = 0.0;  ///< to the left
  double sigma_m = 0.3;
  double probability = 1.0;
  /// Of (x, y) where it is known [m^2]: xx, xy, yy; zeros: sigma_m alone.
  std::array<double, 3> covariance{};
  std::optional<std::array<double, 2>> eye_m{};  ///< x, y of the camera; empty: not stated
};

/// Covariance of (x, y) [m^2]: the stated one, else from sigma_m in each coordinate.
[[nodiscard]] Eigen::Matrix2d covariance_of(const Detection& detection);

/// An instant at which people were searched for, and the range of visible ground.
struct Look {
  std::int64_t t_ns = 0;
  /// Visible range in equal sectors counter-clockwise from the vehicle's heading [0.1 m]; empty:
  /// not stated.
  std::vector<std::uint8_t> reach_dm;
};

/// Reads a table of detections: `#timestamp [ns],x [m],y [m],sigma [m],probability [-],
/// eye_x [m],eye_y [m],xx [m^2],xy [m^2],yy [m^2]`. Columns after y are optional; rows may be in
/// any order of time. Throws BadInput with all faults.
[[nodiscard]] std::vector<Detection> read_detections(const std::filesystem::path& file);

/// Reads a table of looks: `#timestamp [ns],reach_0 [m],reach_1 [m],...`. The reach columns are
/// optional; the table has at least one row. Throws BadInput with all faults.
[[nodiscard]] std::vector<Look> read_looks(const std::filesystem::path& file);

/// Creates `folder` and writes `data.csv` and, unless `looks` is empty, `looks.csv`. Throws
/// StorageError.
void write_detections(const std::filesystem::path& folder,
                      std::span<const Detection> detections,
                      std::span<const Look> looks);

/// Path of the folder of the detector's tables in a drive. It may not exist.
[[nodiscard]] std::filesystem::path detector_folder(const std::filesystem::path& drive);

}  // namespace roadbook
