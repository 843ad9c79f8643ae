#pragma once

#include "base/error.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// Thrown if a later change blocks a change: the first stored change wins, the second is refused.
/// LabelStore throws it
/// - from `change`, `remove`, `create_all` and `set_classes` if the given version is not the
/// newest;
/// - from `undo` and `redo` if another labeller changed a label (or the classes) of the step since,
///   or if the step would remove a class that has labels.
/// The labelling server also throws it for a version that a copy of the map file has made.
/// `current` is the label as stored. For a conflict about the classes it has id 0, and only
/// `version` and `who` are set.
class LabelConflict : public Error {
 public:
  explicit LabelConflict(Label current_label);
  Label current;
};

/// Thrown by LabelStore::undo and redo if `StepBack::last` is not the name, or a prefix of the
/// name, of the request that made the labeller's last change. Then another browser page made that
/// change.
class LabelStepElsewhere : public Error {
 public:
  explicit LabelStepElsewhere(const Label& changed);
};

/// Thrown if a class that has labels would be removed: by LabelStore::set_classes, and by `undo` or
/// `redo` of a number of events (`StepBack::count`). Without `count`, they throw LabelConflict.
class LabelClassInUse : public Error {
 public:
  explicit LabelClassInUse(const std::string& kind);
};

}  // namespace roadbook
