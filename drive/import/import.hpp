#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/progress.hpp"

namespace roadbook {

// Recordings of other layouts, rewritten as drives. docs/reference/drive_format.md says for each
// format what is read, and which frames and sizes are assumed because the source does not state
// them.

struct ImportOptions {
  bool overwrite = false;          ///< replaces a drive that is at the target
  double camera_height_m = 1.65;   ///< kitti: height of the first camera over the ground
  double camera_forward_m = 1.03;  ///< kitti: its distance ahead of the rear axle
  /// Share of a source file's rows (images, poses) that may be left out with a warning; more is
  /// refused. A single row never is.
  double max_left_out = 0.1;
};

struct ImportResult {
  std::size_t images = 0;
  std::size_t wheel_rows = 0;
  std::size_t imu_rows = 0;
  std::size_t poses = 0;
  std::vector<Problem> warnings;  ///< what was left out, and why
};

/// "comma2k19", "euroc", "kaist", "kitti", "kitti360", "video".
[[nodiscard]] const std::vector<std::string>& import_formats();

/// Writes `source` as a drive to `out`. Throws BadInput for an unknown format (naming the nearest)
/// and for a source that cannot be used, StorageError where writing fails.
ImportResult import_drive(const std::string& format,
                          const std::filesystem::path& source,
                          const std::filesystem::path& out,
                          const ImportOptions& options = {},
                          const Progress& progress = {});

}  // namespace roadbook
