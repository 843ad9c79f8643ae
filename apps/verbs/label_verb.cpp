#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/label_server/http/http_server.hpp"
#include "apps/label_server/http/page_files.hpp"
#include "apps/label_server/http/token_file.hpp"
#include "apps/label_server/label_api.hpp"
#include "apps/label_server/runs/label_examples.hpp"
#include "apps/label_server/runs/label_look_again.hpp"
#include "apps/label_server/runs/label_oracle_run.hpp"
#include "apps/label_server/runs/label_replay_run.hpp"
#include "apps/user_name.hpp"
#include "apps/verb.hpp"
#include "base/error.hpp"
#include "semantics/labels/label_drives.hpp"
#include "semantics/labels/label_layers.hpp"
#include "workflows/drive_images.hpp"
#include "workflows/people/people_detect.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

struct LabelCommand {
  std::filesystem::path map;
  std::vector<std::filesystem::path> drives;
  std::filesystem::path token_file;
  std::string who;
  std::filesystem::path oracle;
  std::filesystem::path classifier;
  std::string questions = "telling";
  std::string negatives = "random";
  std::uint64_t seed = 1;
  int port = 8765;
  double idle_s = 0.0;
  bool look_again = false;
  bool replay = false;
};

// Until a signal, or until nobody has had the page open for `idle_s`.
void wait_for_end(const EventHub& hub, double idle_s) {
  using Clock = std::chrono::steady_clock;
  auto last_open = Clock::now();
  while (!interrupted()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (hub.streams() > 0) last_open = Clock::now();
    if (idle_s > 0.0 && Clock::now() - last_open > std::chrono::duration<double>(idle_s)) return;
  }
}

QuestionPolicy question_policy(const std::string& name) {
  if (name == "telling") return QuestionPolicy::kTelling;
  if (name == "uncertain") return QuestionPolicy::kUncertain;
  if (name == "random") return QuestionPolicy::kRandom;
  throw InvalidOption("--questions", name, "telling, uncertain or random");
}

NegativePolicy negative_policy(const std::string& name) {
  if (name == "random") return NegativePolicy::kRandom;
  if (name == "rejected") return NegativePolicy::kRejected;
  throw InvalidOption("--negatives", name, "random or rejected");
}

ExitStatus play(const LabelCommand& command, Console& console, const CommonOptions& common) {
  run_oracle({command.map, command.oracle, question_policy(command.questions),
              negative_policy(command.negatives), command.classifier, command.seed, common.threads},
             console);
  return ExitStatus::kDone;
}

// Without an overhead image there are people to label, where there are images of a drive.
void people_alone(const std::filesystem::path& map,
                  const std::vector<std::optional<Drive>>& drives,
                  const Console& console) {
  Problem lack = no_overhead_image(map);
  if (std::none_of(drives.begin(), drives.end(), [](const auto& d) { return d.has_value(); })) {
    lack.want += ", or a drive to label people in (--drive FOLDER)";
    throw BadInput(lack);
  }
  lack.severity = Severity::kWarning;
  lack.want += " for labels on the ground; people can be labelled";
  console.warn({lack});
}

void wait_for_labeller(const LabelCommand& command,
                       HttpServer& server,
                       const LabelApi& api,
                       EventHub& hub,
                       Console& console) {
  server.start([&api](const HttpRequest& request) { return api.answer(request); });
  if (!page_file("index.html"))
    console.warn({{Severity::kWarning, "roadbook", 0, "labelling page",
                   "a program built without npm", "npm when building; only /api answers"}});
  console.say("labelling page: " + server.address());
  console.say("ends with Ctrl+C; every action is stored as soon as the page shows it");
  std::cout.flush();
  wait_for_end(hub, command.idle_s);
  hub.close();
  server.stop();
}

// Until the labeller ends it; the number of changes.
std::size_t serve(const LabelCommand& command,
                  HttpServer& server,
                  Console& console,
                  const CommonOptions& common) {
  const LabelPlace place = read_label_place(command.map);
  const std::string picture = picture_version(place.image);
  LearningRecord record = record_on(picture, place.learnt_picture, place.learnt_record);
  BoxLearnerOptions learner;
  learner.search.num_threads = common.threads;
  ExamplesByKind taught = command.classifier.empty() ? stored_examples(command.map)
                                                     : examples_of_map(command.classifier, learner);
  LabelStore store(command.map);
  if (!command.classifier.empty()) store.write_table(examples_table(taught));
  if (const auto lost = warning_of_lost_places(command.map, store.map(), store.labels()))
    console.warn({*lost});
  const auto drives = open_session_drives(command.map, store.map(), command.drives, console);
  if (!place.has_picture()) people_alone(command.map, drives, console);
  const AnchorViews views(&store.map(), &drives);
  PeopleDetectOptions people_options;
  people_options.learner.num_threads = common.threads;
  const PeopleImages images(&store.map(), &drives, people_options.learner, people_options.every_s);
  const TilePyramid tiles(place.image);
  EventHub hub;
  LabelBook book(&store, &hub, &images, place.classes);
  const std::size_t before = store.events().size();
  Learning learning(place.image, learner, &book, &hub, std::move(taught), std::move(record),
                    [&](const LearningRecord& r) { store.write_table(record_table(picture, r)); });
  PeopleLearning people(&images, &book, &hub, place.people, people_options.learner,
                        place.people_record,
                        [&](const PeopleRecord& r) { store.write_table(people_record_table(r)); });
  const bool at_hand = std::any_of(drives.begin(), drives.end(),
                                   [](const auto& drive) { return drive.has_value(); });
  PaintWatch paint(&book, at_hand ? images_of_drives(&store.map(), &drives) : KeyframeImages(),
                   &hub, place.sightings,
                   [&](const auto& found) { store.write_table(label_sightings_table(found)); });
  const LabelApi api({&place, picture, &tiles, &views, &book, &learning, &people, &paint, &hub,
                      user_name(command.who)});
  wait_for_labeller(command, server, api, hub, console);
  return store.events().size() - before;
}

ExitStatus run_label(const LabelCommand& command, Console& console, const CommonOptions& common) {
  if (!command.oracle.empty()) return play(command, console, common);
  if (command.look_again) {
    run_look_again(command.map, command.drives, console);
    return ExitStatus::kDone;
  }
  if (command.replay)
    return run_replay(command.map, command.drives, common.threads, console) ? ExitStatus::kDone
                                                                            : ExitStatus::kRefused;
  HttpServerOptions server_options;
  server_options.port = command.port;
  if (!command.token_file.empty()) server_options.token = kept_token(command.token_file);
  HttpServer server(server_options);  // first: a port in use shows at once
  const std::size_t changes = serve(command, server, console, common);
  try {
    // Also where a server before this one was killed.
    if (changes > 0 || !label_layers_are_current(command.map)) renew_label_layers(command.map);
  } catch (const StorageError& fault) {
    throw StorageError(std::string(fault.what()) +
                       "; every label is stored, but the map's layers of them are older");
  }
  const std::size_t labels = read_labels(command.map).size();
  console.say(std::to_string(labels) + " labels, " + std::to_string(changes) + " changes");
  console.result({{"labels", labels}, {"changes", changes}});
  return ExitStatus::kDone;
}

void add_page_options(Options& options, LabelCommand& command) {
  options.add("--map,-m", &command.map, "map file; for the ground with an overhead image")
      .required = true;
  add_drive_option(options, &command.drives);
  options.add("--port", &command.port, "on this machine; 0: any that is free").range = {0, 65535};
  options.add("--who", &command.who, "name of the labeller; default: the user's");
  options.add("--token-file", &command.token_file, "keeps the address's secret for the next start");
}

void add_learning_options(Options& options, LabelCommand& command) {
  options.add("--oracle", &command.oracle,
              "simulated drive of the map: its truth plays the labeller, no page");
  options.add("--look-again", &command.look_again,
              "finds the labels in the images of other sessions and stores where");
  options.add("--replay", &command.replay,
              "learns the page's rounds again from the labels' history: the same classifiers?");
  options.add("--questions", &command.questions,
              "oracle: hypotheses asked about: telling, uncertain, random");
  options.add("--classifier", &command.classifier,
              "map (.gpkg) of another place whose labels the detector begins with");
  options.add("--negatives", &command.negatives,
              "oracle: what counts as none: random places and what is rejected, or that alone");
  options.add("--seed", &command.seed, "oracle: of what is drawn by chance");
  options
      .add("--idle-s", &command.idle_s, "ends when no page has been open for so long [s]; 0: never")
      .range = {0.0, 1e6};
}

}  // namespace

Verb label_verb() {
  auto command = std::make_shared<LabelCommand>();
  return {"label", "serves the labelling page of a map on this machine",
          [command](Options& options) {
            add_page_options(options, *command);
            add_learning_options(options, *command);
          },
          [command](Console& console, const CommonOptions& common) {
            return run_label(*command, console, common);
          }};
}

}  // namespace roadbook
