#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/similarity.hpp"

namespace roadbook {

/// Comparison of a session with the truth of its drive.
struct TruthComparison {
  int session = 0;
  TrajectoryError error;               ///< rigidly aligned; with scale if the map's scale is free
  std::vector<Eigen::Vector2d> truth;  ///< truth in the map frame
  std::vector<Eigen::Vector2d> error_along_m;  ///< travelled [m], error [m]
};

struct TruthComparisons {
  std::vector<TruthComparison> sessions;
  std::vector<std::string> without_truth;  ///< the reason, one line per other session
};

/// Compares the keyframes of each session with the true poses of its drive. `map_file` locates the
/// drives. A drive that is not available or has no truth gives a line in `without_truth`.
[[nodiscard]] TruthComparisons compare_with_truth(const std::filesystem::path& map_file,
                                                  const Map& map);

}  // namespace roadbook
