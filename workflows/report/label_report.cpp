#include "workflows/report/label_report.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "mapping/store/map_event_log.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_sightings.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {
namespace {

using Ring = std::vector<Eigen::Vector2d>;

Ring ring_of(const Map& map, const Label& label) {
  Ring ring;
  for (const auto& corner : corners_in_map(map, label)) ring.emplace_back(corner.head<2>());
  if (!ring.empty()) ring.push_back(Ring::value_type(ring.front()));
  return ring;
}

// Searches for all labels in the newest session. Labels that are found get a sighting.
std::vector<LabelEvidence> look_for(const Map& map,
                                    std::vector<Label>& labels,
                                    const KeyframeImages& images) {
  const int newest = static_cast<int>(map.sessions.size()) - 1;
  std::vector<LabelEvidence> all;
  for (Label& label : labels) {
    if (is_rejected_kind(label.kind)) continue;
    all.push_back(look_again(map, label, newest, images));
    if (all.back().status != EvidenceStatus::kFound) continue;
    std::erase_if(label.sightings,
                  [&](const LabelSighting& s) { return s.anchor.session == newest; });
    label.sightings.push_back(sighting_of(map, label, all.back()));
  }
  return all;
}

std::string names_of(const Map& map) {
  std::string names;
  for (const Session& session : map.sessions) names += (names.empty() ? "" : ", ") + session.name;
  return names;
}

// Loads the earlier map. Its places are comparable if both maps begin with the same drive, because
// coordinates start at the first pose.
Map load_earlier(const std::filesystem::path& before, const Map& map) {
  Map earlier = load_map(before);
  int shared = 0;
  for (std::size_t s = 0; s < map.sessions.size(); ++s)
    shared += same_session(map, static_cast<int>(s), earlier) ? 1 : 0;
  const auto refuse = [&](const std::string& want) {
    throw BadInput(
        {Severity::kError, before.string(), 0, "drives of --before", names_of(earlier), want});
  };
  if (shared == 0) refuse("an earlier state of the map, which is of " + names_of(map));
  if (same_session(map, 0, earlier) != 0)
    refuse("a map that begins with the same drive, " + map.sessions.front().name +
           ": places are told from its first pose");
  return earlier;
}

}  // namespace

std::vector<LabelShift> LabelReport::to_look_at() const {
  std::vector<LabelShift> look;
  for (const LabelShift& shift : shifts.shifts)
    if (shift.sigmas > kLargestShiftSigmas) look.push_back(shift);
  std::stable_sort(look.begin(), look.end(), [](const LabelShift& a, const LabelShift& b) {
    return a.metres() > b.metres();
  });
  return look;
}

std::vector<std::int64_t> LabelReport::gone() const {
  std::vector<std::int64_t> ids;
  for (const LabelEvidence& one : evidence)
    if (one.status == EvidenceStatus::kGone) ids.push_back(one.id);
  return ids;
}

std::optional<LabelReport> collect_labels(const std::filesystem::path& map_file,
                                          const Map& map,
                                          const std::filesystem::path& before,
                                          const KeyframeImages& images) {
  std::optional<Map> earlier;
  if (!before.empty()) earlier = load_earlier(before, map);
  auto labels = read_labels(map_file);
  const LabelReplay replay(read_event_log(map_file, kLabelLog), map_file.string());
  const auto& events = replay.events();
  const auto events_before = before.empty() ? std::vector<LabelEvent>() : read_label_events(before);
  if (events.empty() && events_before.empty()) return std::nullopt;
  LabelReport report;
  report.effort = label_effort(replay);
  add_sightings(read_label_sightings(MapLayers(map_file)), labels);
  if (images) report.evidence = look_for(map, labels, images);
  report.agreement = agreement_of(map, labels);
  if (earlier) {
    report.before = before.filename().string();
    report.differences = label_differences(events_before, events);
    report.shifts = label_shifts(*earlier, map, labels);
    for (const LabelShift& shift : report.shifts.shifts)
      report.outlines_before.push_back(ring_of(*earlier, *label_for(map, *earlier, shift.label)));
  } else {
    report.shifts = shifts_since_seen(map, labels);
  }
  for (const LabelShift& shift : report.shifts.shifts)
    report.outlines.push_back(ring_of(map, shift.label));
  return report;
}

}  // namespace roadbook
