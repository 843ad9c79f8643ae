#pragma once

#include <string>
#include <vector>

#include "base/progress.hpp"
#include "mapping/map.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

/// A session that came from another map.
struct MergedSession {
  int session = 0;               ///< in the other map; its index in the merged one is `merged`
  int merged = 0;                ///< index in the merged map
  std::size_t keyframes = 0;     ///< of the session
  double localised_share = 0.0;  ///< of them, localised in the map that it came to
};

struct MergedMap {
  Map map;
  std::vector<MergedSession> sessions;  ///< in the order in which they came
};

/// `map` with the sessions of `other`, a map of the same place [metric-semantic maps, sections IV-B
/// and IV-C, over maps].
///
/// Each session comes as a drive extends a map (`extend_map`), with the stored observations,
/// corners and descriptors in place of images and its poses in `other` as odometry: its keyframes
/// are localised, the pose graph is relaxed, landmarks are joined, and the map is adjusted as
/// `MapOptions::adjust` says. Loops within a session are kept. The session with the largest share
/// of localised keyframes comes first, so that a session without overlap with `map` may join it by
/// another one of `other`.
///
/// Names of sessions and drives are those of `other`; the caller keeps them apart. The same bytes
/// on any number of threads. Throws Refused if a session has no overlap or too little of it;
/// Interrupted.
[[nodiscard]] MergedMap merged_map(const Map& map,
                                   const Map& other,
                                   const MapOptions& options,
                                   const Progress& progress = {});

}  // namespace roadbook
