#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.hpp"
#include "mapping/corner_tracks.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"
#include "mapping/pipeline/ground.hpp"

namespace roadbook {

// From corners and odometry to a bundle problem, and back.

struct BundleStageOptions {
  /// Observations of one image that take part, spread evenly; of a rig of four cameras. One camera
  /// alone gives as many as four.
  int per_image = 45;
  /// Of one corner in one pass only the views of so many keyframes to either side of the one
  /// nearest to it take part: farther ones see it smaller, and would join every pose with every
  /// other (docs/results/accuracy_and_speed.md).
  int reach_keyframes = 20;
  double feature_sigma_px = 0.6;  ///< half-size image
  double wheel_scale_sigma = 0.005;
  double ground_sigma_m = 0.02;
  BundleOptions bundle;
  GroundOptions ground;
};

/// The problem with what its indices mean.
struct BundleStage {
  BundleProblem problem;
  std::vector<int> track_of_point;    ///< index in the corner tracks
  std::vector<int> camera_base;       ///< of each session: its first camera in problem.cameras
  std::vector<int> scale_of_session;  ///< index of the wheels' factor, -1: none
};

/// Chooses the corners (revisited and long ones first, evenly over each image) and writes down
/// observations, the wheels' motions, ground heights. Poses start at `T_map_vehicle`.
[[nodiscard]] BundleStage make_bundle(const MappingInput& input,
                                      const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                      const std::vector<CornerTrack>& tracks,
                                      const BundleStageOptions& options);

}  // namespace roadbook
