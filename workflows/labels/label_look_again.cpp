#include "workflows/labels/label_look_again.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/format.hpp"
#include "semantics/labels/label_agreement.hpp"
#include "semantics/labels/label_sightings.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/drive_images.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

void require(bool there, const std::filesystem::path& map, const char* field, const char* want) {
  if (!there) throw BadInput({Severity::kError, map.string(), 0, field, "too few", want});
}

}  // namespace

nlohmann::ordered_json run_look_again(const std::filesystem::path& map,
                                      const std::vector<std::filesystem::path>& drives,
                                      Messages& messages) {
  LabelStore store(map);
  auto labels = store.labels();
  require(std::any_of(labels.begin(), labels.end(), is_on_ground), map, "labels",
          "at least one label on the ground (roadbook label -m MAP)");
  require(store.map().sessions.size() > 1, map, "sessions",
          "at least two: labels are searched in the images of the other sessions");
  const auto opened = open_session_drives(map, store.map(), drives, messages);
  require(
      std::count_if(opened.begin(), opened.end(), [](const auto& d) { return d.has_value(); }) > 1,
      map, "drives", "the recordings of at least two sessions (--drive FOLDER)");
  SightingRecord record(read_label_sightings(MapLayers(map)));
  look_for_sightings(store.map(), labels, images_of_drives(&store.map(), &opened), record,
                     messages.progress());
  const auto sightings = record.sightings();
  store.write_table(label_sightings_table(sightings));
  add_sightings(sightings, labels);
  const LabelAgreement agreement = agreement_of(store.map(), labels);
  messages.say(std::to_string(agreement.sightings.size()) +
               " sightings of labels in other sessions, median distance " +
               fixed(100.0 * agreement.median_m, 1) + " cm (" + fixed(agreement.median_sigmas, 1) +
               " standard deviations): " +
               (agreement.contradicts() ? "more than the poses allow, the map is distorted"
                                        : "the distances agree with the poses"));
  return {{"labels", labels.size()},
          {"sightings", agreement.sightings.size()},
          {"median_m", agreement.median_m},
          {"median_sigmas", agreement.median_sigmas},
          {"contradicts", agreement.contradicts()}};
}

}  // namespace roadbook
