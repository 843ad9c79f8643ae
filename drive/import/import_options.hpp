#pragma once

#include <cstddef>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

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

}  // namespace roadbook
