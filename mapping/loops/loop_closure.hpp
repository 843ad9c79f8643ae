#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.hpp"
#include "mapping/joined_tracks.hpp"
#include "mapping/loops/feature_match.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// Loop closure: finds revisits by appearance and verifies them by the geometry of the whole rig.

struct LoopOptions {
  double min_travel_m = 10.0;         ///< driven between the two keyframes of a loop
  double drift_fraction = 0.05;       ///< assumed odometry error per distance: gate for candidates
  double drift_fraction_blind = 0.3;  ///< the same without wheels
  double gate_m = 4.0;                ///< added to the gate
  std::size_t candidates = 3;         ///< verified per keyframe
  int suppress = 6;                   ///< smallest difference of index between two candidates
  int min_inliers = 30;               ///< matches that agree on one pose; one camera: 2/3 of it
  double min_inlier_share = 0.25;     ///< of the matches
  double max_offset_m = 6.0;          ///< between the two vehicle poses
  int max_hamming = 105;              ///< of 512 bits
  double max_ratio = 0.88;            ///< nearest over second-nearest descriptor distance
  double inlier_px = 3.0;             ///< half-size image
  int num_threads = 0;
};

/// A revisit and its matches. Rejected ones are kept, with the reason in `edge`.
struct LoopClosure {
  LoopEdge edge;  ///< from: earlier keyframe, to: later one
  std::vector<FeatureMatch> matches;
  /// Without wheels, the scale of the later pass relative to the earlier one
  /// (mapping/loops/loop_scale.hpp); `edge` is in units of the earlier pass.
  double log_scale = 0.0;
  double log_scale_sigma = 0.0;  ///< 0: not measured
};

/// For each keyframe the index of its segment, counted from 0. A new segment begins after each gap.
[[nodiscard]] std::vector<int> segments_of(const std::vector<VoKeyframe>& keyframes);

/// Two keyframes that may show the same place.
struct KeyframePair {
  int earlier = 0;
  int later = 0;
};

/// Compares every keyframe with the earlier ones and verifies the best candidates (`verify_loops`).
/// Deterministic on any number of threads.
[[nodiscard]] std::vector<LoopClosure> find_loops(const MappingInput& input,
                                                  const LoopOptions& options,
                                                  const Progress& progress = {});

/// Verifies each pair by the geometry of the whole rig; `pairs` ascend by their later keyframe. A
/// loop is accepted with enough inliers and a neighbouring loop that agrees, or with three times
/// the inliers, unless the odometry contradicts it (mapping/loops/odometry_check.hpp). Returns one
/// loop a pair. Deterministic on any number of threads.
[[nodiscard]] std::vector<LoopClosure> verify_loops(const MappingInput& input,
                                                    const std::vector<KeyframePair>& pairs,
                                                    const LoopOptions& options,
                                                    const Progress& progress = {});

}  // namespace roadbook
