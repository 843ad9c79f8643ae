#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "semantics/labels/label_replay.hpp"

namespace roadbook {

// Finds the step that an undo or redo of one labeller applies to: the newest step that no other
// labeller's change blocks. Steps listed in StepBack::passed are skipped.

/// Event numbers of that step, newest first; empty if there is nothing to undo (with `undone`: to
/// redo). Throws LabelConflict if another labeller changed a label or the classes of the step
/// since. With `step.count` 0, also throws it (id 0: the classes) if the step would remove a class
/// that has labels. Throws LabelStepElsewhere if the request that made the step does not match
/// `step.last`.
[[nodiscard]] std::vector<std::int64_t> last_step(const LabelReplay& replay,
                                                  const std::string& who,
                                                  bool undone,
                                                  const StepBack& step);

/// The list of classes as a LabelConflict reports it: id 0, with version and who.
[[nodiscard]] Label standing(const LabelClassList& classes);

}  // namespace roadbook
