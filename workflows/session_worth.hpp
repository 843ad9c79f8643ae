#pragma once

#include <vector>

#include "mapping/sessions/session_value.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// What each session of a map is worth to the poses, labels and landmarks of the others
/// (`session_values`). The middles of the labels on the ground are the points. A label whose image
/// is no keyframe hangs on the nearest one of its session.
[[nodiscard]] std::vector<SessionValue> worth_of_sessions(const Map& map,
                                                          const std::vector<Label>& labels);

}  // namespace roadbook
