#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.hpp"
#include "mapping/corner_tracks.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// Loop closure: revisits found by appearance, verified by geometry over the whole rig.

struct LoopOptions {
  double min_travel_m = 10.0;         ///< driven between two keyframes that may close a loop
  double drift_fraction = 0.05;       ///< odometry error after a distance, as a gate for candidates
  double drift_fraction_blind = 0.3;  ///< the same without wheels
  double gate_m = 4.0;                ///< added to the gate
  std::size_t candidates = 3;         ///< verified per keyframe
  int suppress = 6;                   ///< keyframes about a candidate that are not candidates too
  int min_inliers = 30;            ///< corners that agree on one pose (a single camera: 2/3 of it)
  double min_inlier_share = 0.25;  ///< of the matched corners
  double max_offset_m = 6.0;       ///< between the two vehicle poses
  int max_hamming = 105;
  double max_ratio = 0.88;
  double inlier_px = 3.0;  ///< half-size image
  int num_threads = 0;
};

/// Two features that show the same corner.
struct FeatureMatch {
  int from_camera = 0;
  int from_feature = 0;
  int to_camera = 0;
  int to_feature = 0;
};

/// A revisit with what supports it; refused ones are kept with the reason.
struct LoopClosure {
  LoopEdge edge;  ///< from: earlier keyframe, to: later one
  std::vector<FeatureMatch> matches;
};

/// Index of the piece of the drive a keyframe belongs to: a new one begins after each gap.
[[nodiscard]] std::vector<int> segments_of(const std::vector<VoKeyframe>& keyframes);

/// Every keyframe is compared with the earlier ones.
/// An edge needs enough inliers and the agreement of a neighbouring edge (or twice the inliers).
/// Deterministic on any number of threads.
[[nodiscard]] std::vector<LoopClosure> find_loops(const MappingInput& input,
                                                  const LoopOptions& options,
                                                  const Progress& progress = {});

}  // namespace roadbook
