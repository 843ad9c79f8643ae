#pragma once

#include <vector>

#include "mapping/sessions/session_value.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// The value of each session for the poses, labels and landmarks of the others (`session_values`).
/// The points are the middles of the labels on the ground. A label moves with the keyframe of its
/// session that is nearest in time.
[[nodiscard]] std::vector<SessionValue> worth_of_sessions(const Map& map,
                                                          const std::vector<Label>& labels);

}  // namespace roadbook
