#include "workflows/labels/label_boxes.hpp"

#include <map>

#include "semantics/labels/label_classes.hpp"

namespace roadbook {

void LabelBoxes::add(const Map& map, const Label& label, const std::string& kind) {
  if (label.state == LabelState::kDeleted) return;
  const bool is_positive = label.kind == kind;
  if (!is_positive && label.kind != rejected_kind(kind)) return;
  if (const auto box = box_in_map(map, label))
    (is_positive ? positives : negatives).push_back(*box);
}

LabelBoxes label_boxes(const Map& map,
                       const std::vector<LabelEvent>& events,
                       const std::string& kind) {
  std::map<std::int64_t, const Label*> labels;
  for (const LabelEvent& event : events)
    if (event.action != LabelAction::kClasses) labels[event.label.id] = &event.label;
  LabelBoxes boxes;
  for (const auto& [id, label] : labels) boxes.add(map, *label, kind);
  return boxes;
}

}  // namespace roadbook
