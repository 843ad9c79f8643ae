#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.hpp"
#include "mapping/joined_tracks.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"
#include "mapping/pipeline/ground.hpp"
#include "mapping/pipeline/pass_numbers.hpp"

namespace roadbook {

// Makes the bundle adjustment problem from joined tracks and odometry.

struct BundleStageOptions {
  /// Observations of one image that take part, spread evenly, in a rig of four cameras. With fewer
  /// cameras each image gives more, so that a keyframe has about as many.
  int per_image = 45;
  /// In each pass a track takes part with the key points of at most this many keyframes before and
  /// after the keyframe nearest to it. More would couple all poses with each other and cost time
  /// (docs/results/speed.md).
  int reach_keyframes = 20;
  /// The same in passes after the first `passes_together` over a place.
  int reach_of_many_passes = 12;
  /// Passes over one place are taken in groups of so many, in the order in which they were driven.
  /// The last pass of a group is the first one of the next. A point has key points of one group, a
  /// track may have a point in each: the cost is linear in the passes. At least 2; 0: all together.
  int passes_together = 4;
  PlacePassOptions passes;
  double feature_sigma_px = 0.6;     ///< of a key point, half-size image
  double wheel_scale_sigma = 0.005;  ///< prior of the factor on the wheels' distance
  double ground_sigma_m = 0.02;
  BundleOptions bundle;
  GroundOptions ground;
};

/// A bundle problem and the meaning of its indices.
struct BundleStage {
  BundleProblem problem;
  std::vector<int> track_of_point;    ///< index in the joined tracks, ascending
  std::vector<int> camera_base;       ///< of each session: index of its first camera
  std::vector<int> scale_of_session;  ///< index of its wheels' factor; -1: no wheels
};

/// Chooses tracks (revisited and long ones first, evenly over each image) as points, and adds their
/// observations, the wheels' motions and the ground heights. Poses start at `T_map_vehicle`.
[[nodiscard]] BundleStage make_bundle(const MappingInput& input,
                                      const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                      const std::vector<JoinedTrack>& tracks,
                                      const BundleStageOptions& options);

/// Positions [m, map] of the tracks whose points the adjustment kept (`BundleResult::point_kept`):
/// the mean of a track's points, each by its views.
[[nodiscard]] std::vector<std::optional<Eigen::Vector3d>> adjusted_places(
    const BundleStage& stage, const std::vector<std::uint8_t>& point_kept, std::size_t tracks);

}  // namespace roadbook
