#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/messages.hpp"
#include "exchange/layers/dropped_work.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

struct MergeRequest {
  std::filesystem::path map;    ///< is extended
  std::filesystem::path other;  ///< is only read
  SessionAdjust adjust = SessionAdjust::kNear;
  int num_threads = 0;
};

/// A session that came from the other map.
struct MergeRow {
  std::string name;
  std::size_t keyframes = 0;
  double localised_share = 0.0;
};

struct MergeResult {
  std::vector<MergeRow> came;  ///< in the order in which they came
  std::size_t sessions = 0;    ///< of the map now
  std::size_t keyframes = 0;
  std::size_t landmarks = 0;
  std::size_t labels = 0;            ///< copied from the other map
  std::vector<DroppedWork> dropped;  ///< layers and tables that do not fit the moved poses
  std::string digest;                ///< of the map
};

/// Adds the sessions of another map of the same place to a map (`merged_map`), with their labels.
/// No recording is read. Other layers and tables of the other map are not copied. Those of the map
/// stay as after an extension with the same `adjust`. The map file is replaced in one step at the
/// end.
///
/// Throws BadInput (names of sessions or drives that both have, a file that is no map), Refused (no
/// overlap, maps of several pieces), StorageError, Interrupted. The map then is unchanged.
MergeResult merge_maps(const MergeRequest& request, Messages& messages);

}  // namespace roadbook
