#pragma once

#include <cstddef>

#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// How often the 95 % regions that a map states hold the true errors. The judge is the truth of the
// simulator: poses (state_groundtruth_estimate0) and range images (truth/range).

/// Errors compared with one kind of region.
struct RegionShare {
  std::size_t count = 0;
  std::size_t inside = 0;
  double squares = 0.0;  ///< sum of e^T C^-1 e over the dimension of e

  /// Share of the errors inside; NaN without errors.
  [[nodiscard]] double share() const;
  /// Mean squared error over its variance; 1 if the covariances are right, NaN without errors.
  [[nodiscard]] double mean_square() const;
  void add(double squared_distance, int dimension);
  void add(const RegionShare& other);
};

struct Coverage {
  RegionShare position;     ///< x and y
  RegionShare position_3d;  ///< x, y, z
  RegionShare heading;
  RegionShare six;          ///< all of the pose
  RegionShare landmarks;    ///< along the ray of the nearest view, off outlines
  std::size_t unknown = 0;  ///< keyframes without a covariance

  void add(const Coverage& other);
};

/// Compares a map of one drive with the truth of the drive. Errors of poses are relative to the
/// first keyframe of the keyframe's piece, as the covariances are. Landmarks are left out where the
/// drive has no range images. Throws the exceptions of `Drive::truth`.
[[nodiscard]] Coverage coverage_of(const Map& map, const Drive& drive);

}  // namespace roadbook
