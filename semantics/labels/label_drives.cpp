#include "semantics/labels/label_drives.hpp"

#include <map>
#include <string>

#include "base/error.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {
namespace {

using CountBySession = std::map<int, std::size_t>;

std::string named(const CountBySession& labels, const Map& map) {
  std::string text;
  for (const auto& [session, count] : labels) {
    const bool known = session >= 0 && session < static_cast<int>(map.sessions.size());
    text += (text.empty() ? "" : ", ") + std::to_string(count) +
            (known ? " of drive " + map.sessions[static_cast<std::size_t>(session)].name
                   : " of drive number " + std::to_string(session + 1) + ", which it lacks");
  }
  return text;
}

}  // namespace

void check_labels_stay(const std::filesystem::path& file, const ExistingMap& existing) {
  CountBySession lost;
  for (const auto& labels : {read_labels(file), read_image_labels(file)})
    for (const Label& label : labels)
      if (label.anchor.session >= static_cast<int>(existing.stay)) ++lost[label.anchor.session];
  if (lost.empty()) return;
  throw BadInput({Severity::kError, file.string(), 0, "labels", named(lost, existing.map),
                  "these drives first, in this order (" + existing.names() +
                      "), or another map file (export and import keep the labels)"});
}

std::optional<Problem> warning_of_lost_places(const std::filesystem::path& file,
                                              const Map& map,
                                              const std::vector<Label>& labels) {
  CountBySession lost;
  for (const Label& label : labels)
    if (is_on_ground(label) && label.state == LabelState::kActive && !vehicle_of(map, label.anchor))
      ++lost[label.anchor.session];
  if (lost.empty()) return std::nullopt;
  return Problem{Severity::kWarning,
                 file.string(),
                 0,
                 "labels without a place",
                 named(lost, map),
                 "a pose at the time of each label; the labels are kept, but no layer and no "
                 "export contains them"};
}

}  // namespace roadbook
