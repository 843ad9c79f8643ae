#pragma once

#include "base/error.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// A change was meant for another version of the label (or the classes) than the newest: `Label` as
/// it stands; of classes id 0, version and who alone.
class LabelConflict : public Error {
 public:
  explicit LabelConflict(Label current_label);
  Label current;
};

/// A step back was meant for another change than the last one of that person, which some other page
/// has made.
class LabelStepElsewhere : public Error {
 public:
  explicit LabelStepElsewhere(const Label& changed);
};

/// A list of classes, or a step back, would take away a class of which there are labels.
class LabelClassInUse : public Error {
 public:
  explicit LabelClassInUse(const std::string& kind);
};

}  // namespace roadbook
