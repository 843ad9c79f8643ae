#pragma once

#include "base/error.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// Thrown if a change names a version that is no longer the newest one, because another change came
/// first: the first stored change wins and the second is refused. `current` is the label as stored;
/// for a conflict about the list of classes it has id 0, and only `version` and `who` are set.
class LabelConflict : public Error {
 public:
  explicit LabelConflict(Label current_label);
  Label current;
};

/// Thrown if an undo or redo names another request than the one that made the user's last change,
/// for example because that change was made in another browser page.
class LabelStepElsewhere : public Error {
 public:
  explicit LabelStepElsewhere(const Label& changed);
};

/// Thrown if a new list of classes, or an undo, would remove a class that has labels.
class LabelClassInUse : public Error {
 public:
  explicit LabelClassInUse(const std::string& kind);
};

}  // namespace roadbook
