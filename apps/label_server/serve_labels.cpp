#include "apps/label_server/serve_labels.hpp"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>

#include "apps/label_server/http/page_files.hpp"
#include "apps/label_server/label_api.hpp"
#include "apps/user_name.hpp"
#include "base/error.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "mapping/store/map_file_open.hpp"
#include "semantics/labels/label_drives.hpp"
#include "semantics/labels/label_layers.hpp"
#include "workflows/drive_images.hpp"
#include "workflows/labels/label_examples.hpp"
#include "workflows/people/people_detect.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

// Waits until a signal arrives, or until no page has been open for `idle_s` seconds.
void wait_for_end(const EventHub& hub, double idle_s) {
  using Clock = std::chrono::steady_clock;
  auto last_open = Clock::now();
  while (!interrupted()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (hub.streams() > 0) last_open = Clock::now();
    if (idle_s > 0.0 && Clock::now() - last_open > std::chrono::duration<double>(idle_s)) return;
  }
}

// A map without an overhead image only allows the labelling of people, if images of a drive exist.
void people_alone(const std::filesystem::path& map,
                  const std::vector<std::optional<Drive>>& drives,
                  const Console& console) {
  Problem lack = no_overhead_image(map);
  if (std::none_of(drives.begin(), drives.end(), [](const auto& d) { return d.has_value(); })) {
    lack.want += ", or a recording in which people can be labelled (--drive FOLDER)";
    throw BadInput(lack);
  }
  lack.severity = Severity::kWarning;
  lack.want += " for labels on the ground; people can be labelled";
  console.warn({lack});
}

void wait_for_labeller(const LabelServerRequest& request,
                       HttpServer& server,
                       const LabelApi& api,
                       EventHub& hub,
                       Console& console) {
  server.start([&api](const HttpRequest& asked) { return api.answer(asked); });
  if (!page_file("index.html"))
    console.warn(
        {{Severity::kWarning, "roadbook", 0, "labelling page", "a program built without npm",
          "a build with npm; this server answers only /api"}});
  console.say("labelling page: " + server.address());
  console.say("press Ctrl+C to end; changes that the page shows as saved are in the map file");
  std::cout.flush();
  wait_for_end(hub, request.idle_s);
  hub.close();
  server.stop();
}

// Serves until the user ends the program. Returns the number of changes.
std::size_t serve(const LabelServerRequest& request, HttpServer& server, Console& console) {
  const LabelPlace place = read_label_place(request.map);
  const std::string picture = picture_version(place.image);
  LearningRecord record = record_on(picture, place.learnt_picture, place.learnt_record);
  BoxLearnerOptions learner;
  learner.search.num_threads = request.num_threads;
  ExamplesByKind taught = request.classifier.empty() ? stored_examples(request.map)
                                                     : examples_of_map(request.classifier, learner);
  LabelStore store(request.map);
  if (!request.classifier.empty()) store.write_table(examples_table(taught));
  if (const auto lost = warning_of_lost_places(request.map, store.map(), store.labels()))
    console.warn({*lost});
  const auto drives = open_session_drives(request.map, store.map(), request.drives, console);
  if (!place.has_picture()) people_alone(request.map, drives, console);
  const AnchorViews views(&store.map(), &drives);
  PeopleDetectOptions people_options;
  people_options.learner.num_threads = request.num_threads;
  const PeopleImages images(&store.map(), &drives, people_options.learner, people_options.every_s);
  const TilePyramid tiles(place.image);
  EventHub hub;
  LabelService service(&store, &hub, &images, place.classes);
  const std::size_t before = store.events().size();
  Learning learning(place.image, learner, &service, &hub, std::move(taught), std::move(record),
                    [&](const LearningRecord& r) { store.write_table(record_table(picture, r)); });
  PeopleLearning people(&images, &service, &hub, place.people, people_options.learner,
                        place.people_record,
                        [&](const PeopleRecord& r) { store.write_table(people_record_table(r)); });
  const bool at_hand = std::any_of(drives.begin(), drives.end(),
                                   [](const auto& drive) { return drive.has_value(); });
  PaintWatch paint(&service, at_hand ? images_of_drives(&store.map(), &drives) : KeyframeImages(),
                   &hub, place.sightings,
                   [&](const auto& found) { store.write_table(label_sightings_table(found)); });
  const LabelApi api({&place, picture, &tiles, &views, &service, &learning, &people, &paint, &hub,
                      user_name(request.who)});
  wait_for_labeller(request, server, api, hub, console);
  return store.events().size() - before;
}

}  // namespace

std::size_t serve_labels(const LabelServerRequest& request, HttpServer& server, Console& console) {
  // No other process changes the map while pages are open. Other processes may read it.
  const MapHold hold(existing_map_file(request.map));
  const std::size_t changes = serve(request, server, console);
  try {
    // An earlier server may have been killed before it renewed the layers.
    if (changes > 0 || !label_layers_are_current(request.map)) renew_label_layers(request.map);
  } catch (const StorageError& fault) {
    throw StorageError(std::string(fault.what()) +
                       "; all labels are stored, but the label layers of the map are out of date");
  }
  return changes;
}

}  // namespace roadbook
