#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "mapping/pipeline/map_stages.hpp"

namespace roadbook {

// What `map` does in a place whose parts look the same: two equal storeys, a hall with equal bays.
// A loop that joins two such parts is false. The simulator's truth judges every loop.

/// The drive to map.
struct AlikePlace {
  std::string scenario = "storeys";  ///< with `storeys` or `bays`
  std::string size = "full";
  double image_scale = 0.5;
};

/// A simulated drive after odometry.
struct AlikeDrive {
  MappingInput input;
  std::vector<Eigen::Isometry3d> T_world_vehicle;  ///< truth of each keyframe
  /// From a place to those that look the same [m, world].
  std::vector<Eigen::Vector3d> shifts;
};

/// Simulates the drive and runs the odometry. Deterministic. Throws the exceptions of `simulate`
/// and `track_drive`.
[[nodiscard]] AlikeDrive drive_alike_place(const AlikePlace& place,
                                           std::uint64_t seed,
                                           int num_threads,
                                           const Progress& progress = {});

/// Counts of loops, and of those that differ from the truth by more than 0.5 m or 0.1 rad.
struct LoopCount {
  int all = 0;
  int wrong = 0;
};

/// What became of the pairs of one map.
struct AlikeResult {
  int candidates = 0;           ///< pairs compared
  LoopCount verified;           ///< enough corners agree on one rig pose
  LoopCount accepted;           ///< and a neighbouring loop and the odometry's heights agree
  LoopCount kept;               ///< and the pose graph did not reject it
  int forced = 0;               ///< of `candidates`: pairs of equal parts that were offered
  double largest_bend_m = 0.0;  ///< largest distance of a pose from that without wrong loops
};

/// Maps the drive with its own candidates, and with `forced` further pairs of keyframes in places
/// that look the same but are not, evenly chosen.
[[nodiscard]] AlikeResult judge_loops(const AlikeDrive& drive,
                                      int forced,
                                      const MapOptions& options,
                                      const Progress& progress = {});

/// Pairs of keyframes in different places that look the same, evenly chosen among all.
[[nodiscard]] std::vector<KeyframePair> alike_pairs(const AlikeDrive& drive, std::size_t count);

/// Whether the loop's motion differs from the truth by more than 0.5 m or 0.1 rad.
[[nodiscard]] bool is_wrong(const AlikeDrive& drive, const LoopEdge& edge);

}  // namespace roadbook
