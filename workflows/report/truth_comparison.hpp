#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/pipeline/truth_error.hpp"

namespace roadbook {

/// Comparison of a session with the truth of its drive.
struct TruthComparison {
  int session = 0;
  TrajectoryError error;               ///< rigidly aligned; with scale if the map's scale is free
  std::vector<Eigen::Vector2d> truth;  ///< truth in the map frame
  /// Travelled [m], error [m]; both after the common alignment of all sessions, where there is one.
  std::vector<Eigen::Vector2d> error_along_m;
  std::optional<SessionOffset> offset;  ///< against all sessions; empty if they are not comparable
};

struct TruthComparisons {
  std::vector<TruthComparison> sessions;
  std::optional<TrajectoryError> together;  ///< of all sessions (TruthErrors::together)
  std::string apart;                        ///< why there is no `together`
  std::vector<std::string> without_truth;   ///< the reason, one line per other session
};

/// Compares the keyframes of each session, and of all together, with the true poses of the drives.
/// `map_file` locates the drives. A drive that is not available or has no truth gives a line in
/// `without_truth`.
[[nodiscard]] TruthComparisons compare_with_truth(const std::filesystem::path& map_file,
                                                  const Map& map);

}  // namespace roadbook
