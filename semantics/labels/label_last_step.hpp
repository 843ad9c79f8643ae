#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "semantics/labels/label_replay.hpp"

namespace roadbook {

// Which step of a person is the last that can be taken back, or done again: one that nobody else
// stands in the way of, or behind those that this person knows to stand (StepBack).

/// Numbers of its events, newest first; none where there is nothing to take back. Throws
/// LabelConflict where somebody else has changed what the step was about since, or its class is in
/// use; LabelStepElsewhere where another request made it than `step` says.
[[nodiscard]] std::vector<std::int64_t> last_step(const LabelReplay& replay,
                                                  const std::string& who,
                                                  bool undone,
                                                  const StepBack& step);

/// Classes as a LabelConflict tells them: id 0, version and who alone.
[[nodiscard]] Label standing(const LabelClassList& classes);

}  // namespace roadbook
