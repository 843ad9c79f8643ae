#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/joined_tracks.hpp"

namespace roadbook {

// Covariances of landmarks given the poses.
//
// Independent noise of the pixels gives (sum J^T J / sigma^2)^-1. But the error of a corner changes
// slowly from view to view, so many views tell less than that. The map itself shows by how much:
// the views of a track are split into an early and a late half, and both are triangulated alone.
// All covariances are multiplied by the one factor with which the 95 % region holds 95 % of their
// distances. The tail counts: wrong matches and apparent corners are in it.

struct LandmarkCovariances {
  std::vector<Eigen::Matrix3d> of_track;  ///< [m^2], map axes; NaN: unknown
  double factor = 1.0;                    ///< on the covariances of independent noise
  int compared = 0;                       ///< tracks of which both halves could be triangulated
};

/// `tracks` with their positions; `sigma_px` of a key point in the half-size image. The same on any
/// number of threads.
[[nodiscard]] LandmarkCovariances landmark_covariances(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const std::vector<JoinedTrack>& tracks,
    double sigma_px,
    const TriangulationOptions& options);

}  // namespace roadbook
