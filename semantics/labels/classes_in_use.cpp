#include "semantics/labels/classes_in_use.hpp"

#include <algorithm>
#include <set>

namespace roadbook {
namespace {

bool has(const std::vector<LabelClass>& list, const std::string& kind) {
  return std::any_of(list.begin(), list.end(), [&](const auto& c) { return c.kind == kind; });
}

}  // namespace

std::vector<std::string> kinds_in_use(const std::map<std::int64_t, Label>& labels) {
  std::set<std::string> kinds;
  for (const auto& [id, label] : labels)
    if (label.state == LabelState::kActive && is_on_ground(label) && !is_rejected_kind(label.kind))
      kinds.insert(label.kind);
  return {kinds.begin(), kinds.end()};
}

std::optional<std::string> class_in_use(const std::map<std::int64_t, Label>& labels,
                                        const std::vector<LabelClass>& shown,
                                        const std::vector<LabelClass>& wanted) {
  for (const std::string& kind : kinds_in_use(labels))
    if (has(shown, kind) && !has(wanted, kind)) return kind;
  return std::nullopt;
}

}  // namespace roadbook
