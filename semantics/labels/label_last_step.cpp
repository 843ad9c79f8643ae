#include "semantics/labels/label_last_step.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "semantics/labels/classes_in_use.hpp"
#include "semantics/labels/label_conflict.hpp"

namespace roadbook {
namespace {

// Finds what blocks the undo or redo of an event: the present label, or the present classes. Empty
// if the step is possible.
std::optional<Label> in_the_way(const LabelReplay& replay,
                                const LabelEvent& event,
                                const std::string& who,
                                const StepBack& step) {
  const bool of_classes = event.action == LabelAction::kClasses;
  const bool in_use =
      step.count == 0 && of_classes &&
      class_in_use(replay.labels(), replay.classes().classes, event.classes_before).has_value();
  if (!in_use && !replay.changed_by_others(event, who)) return std::nullopt;
  return of_classes ? standing(replay.classes()) : replay.labels().at(event.label.id);
}

bool is_told(const StepBack& step, const Label& changed) {
  const std::pair one{changed.id, changed.version};
  return std::find(step.passed.begin(), step.passed.end(), one) != step.passed.end();
}

}  // namespace

Label standing(const LabelClassList& classes) {
  Label label;
  label.version = classes.version;
  label.who = classes.who;
  return label;
}

std::vector<std::int64_t> last_step(const LabelReplay& replay,
                                    const std::string& who,
                                    bool undone,
                                    const StepBack& step) {
  std::set<std::int64_t> held;  // labels of newer steps that the loop passed over
  for (std::size_t passed = 0;;) {
    const auto numbers = replay.last_of(who, undone, step.count, passed);
    std::optional<Label> changed;
    bool under = false;
    for (const std::int64_t number : numbers) {
      const LabelEvent& event = replay.event(number);
      under = under || held.contains(event.label.id);
      if (!changed) changed = in_the_way(replay, event, who, step);
    }
    if (!under && !(changed && is_told(step, *changed))) {
      if (!numbers.empty() && !replay.request_of(numbers.front()).starts_with(step.last))
        throw LabelStepElsewhere(replay.event(numbers.front()).label);
      if (changed) throw LabelConflict(*changed);
      return numbers;
    }
    for (const std::int64_t number : numbers) held.insert(replay.event(number).label.id);
    passed += numbers.size();
  }
}

}  // namespace roadbook
