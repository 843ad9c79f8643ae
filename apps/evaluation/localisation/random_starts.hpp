#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "mapping/localisation/localise_drive.hpp"

namespace roadbook {

// Where is the car? Asked at random frames of a drive, without a guess.

/// Outcomes of all starts.
struct StartTally {
  std::size_t starts = 0;
  std::size_t right = 0;  ///< confirmed within 2.5 m of driving, off by at most 0.3 m and 2 degrees
  std::size_t late = 0;   ///< the same, after more than 2.5 m
  std::size_t wrong = 0;  ///< found elsewhere
  std::size_t lost = 0;   ///< not found within 6 m
  double largest_try_ms = 0.0;  ///< processor time of the slowest frame, features included
  double mean_try_ms = 0.0;     ///< of the frame that found the place
};

/// Starts at random frames, forwards or backwards in time, and drives on until the pose is
/// confirmed. `T_map_world`: of the world of the drive's truth; empty: the drive is of another
/// place, so that every pose found is wrong. Deterministic, except for times.
[[nodiscard]] StartTally random_starts(const Drive& drive,
                                       const std::vector<cv::Mat>& masks,
                                       const LandmarkIndex& index,
                                       const std::optional<Eigen::Isometry3d>& T_map_world,
                                       std::size_t starts,
                                       std::uint64_t seed,
                                       int num_threads,
                                       const Progress& progress = {});

}  // namespace roadbook
