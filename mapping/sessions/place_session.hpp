#pragma once

#include <vector>

#include "base/progress.hpp"
#include "mapping/joined_tracks.hpp"
#include "mapping/localisation/localiser.hpp"
#include "mapping/loops/loop_closure.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

// A new drive in the coordinates of a map that exists [metric-semantic maps, section IV-C: the
// drive is localised while it is tracked].

/// A keyframe of the drive.
struct PlacedKeyframe {
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  /// Of the right perturbation, relative to the first keyframe of the piece; NaN: unknown.
  Matrix6d covariance = unknown_covariance<Matrix6d>();
  int piece = 0;              ///< of the map, or beyond its pieces: nothing joins it to the map
  bool is_localised = false;  ///< by landmarks of the map
  int near = -1;              ///< keyframe of the map nearest to it; -1: not localised
  std::vector<LandmarkView> views;  ///< landmarks of the map that it sees
  std::vector<int> in_view;         ///< landmarks that project into its images, ascending
};

struct PlacedSession {
  std::vector<PlacedKeyframe> keyframes;
  std::vector<LoopClosure> loops;  ///< within the drive; only where the map does not know the place
  std::size_t localised = 0;
  std::size_t joined = 0;  ///< keyframes in a piece of the map
  int other_pieces = 0;    ///< keyframes localised in another piece than most; they do not count

  [[nodiscard]] double localised_share() const {
    return static_cast<double>(localised) / static_cast<double>(keyframes.size());
  }
};

/// Localises the keyframes of `drive` (one session) in the map of `index`, whose motion the drive's
/// odometry predicts, and relaxes the odometry between them. A fix that contradicts the odometry
/// and the other fixes is dropped. `is_metric`: the odometry is in metres. Deterministic on any
/// number of threads. Throws Refused if the pose graph has no solution; Interrupted.
[[nodiscard]] PlacedSession place_session(const MappingInput& drive,
                                          bool is_metric,
                                          const LandmarkIndex& index,
                                          const MapOptions& options,
                                          const Progress& progress);

}  // namespace roadbook
