#pragma once

#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "mapping/edits/map_edit.hpp"
#include "mapping/map.hpp"
#include "mapping/optimisation/adjustment_problem.hpp"
#include "mapping/optimisation/pose_graph.hpp"

namespace roadbook {

/// What edits say about the keyframes of a map.
struct EditTerms {
  std::vector<RelativePose> motions;  ///< of kLoop and kSamePoints
  std::vector<PosePrior> anchors;
  std::vector<std::pair<int, int>> apart;  ///< keyframes of kNotALoop, ascending
};

/// Throws BadInput for places that the map does not have, and the exceptions of `motion_of_edit`.
[[nodiscard]] EditTerms terms_of_edits(const Map& map, const std::vector<MapEdit>& edits);

/// Whether two keyframes lie around the two places that an edit says are different.
[[nodiscard]] bool are_apart(const Map& map, const EditTerms& terms, int from, int to);

/// Poses of the map relaxed with the edits. Accepted loops count, except those between places that
/// an edit says are different. Throws Refused, and names what contradicts the edits.
[[nodiscard]] std::vector<Eigen::Isometry3d> relaxed_with_edits(const Map& map,
                                                                const std::vector<MapEdit>& edits,
                                                                const EditTerms& terms,
                                                                const PoseGraphOptions& options,
                                                                const Progress& progress);

}  // namespace roadbook
