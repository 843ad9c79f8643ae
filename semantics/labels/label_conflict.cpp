#include "semantics/labels/label_conflict.hpp"

#include <string>
#include <utility>

namespace roadbook {

LabelConflict::LabelConflict(Label current_label)
    : Error(ExitStatus::kRefused,
            "error: " +
                (current_label.id == 0 ? "classes" : "label " + std::to_string(current_label.id)) +
                ": version: got another version, want " + std::to_string(current_label.version)),
      current(std::move(current_label)) {}

LabelStepElsewhere::LabelStepElsewhere(const Label& changed)
    : Error(ExitStatus::kRefused,
            "your last change (" +
                (changed.id == 0 ? "classes" : "label " + std::to_string(changed.id)) +
                ") was made in another page") {}

LabelClassInUse::LabelClassInUse(const std::string& kind)
    : Error(ExitStatus::kRefused,
            "classes: got a list without " + kind + ", want a list with it (it has labels)") {}

}  // namespace roadbook
