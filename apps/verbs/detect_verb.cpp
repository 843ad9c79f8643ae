#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/label_server/taught_people.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"
#include "base/error.hpp"
#include "base/format.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/people/person_labels.hpp"
#include "workflows/people/people_detect.hpp"
#include "workflows/people/people_store.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

struct DetectCommand {
  std::filesystem::path map;
  std::vector<std::filesystem::path> drives;
  std::vector<std::string> oracle;
  std::vector<std::string> sessions;
  std::filesystem::path from;
  std::filesystem::path vehicle;
  bool anew = false;
  PeopleDetectOptions options;
};

std::size_t session_index(const Map& map, const char* option, const std::string& name) {
  std::string want;
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    if (map.sessions[s].name == name) return s;
    want += (want.empty() ? "" : ", ") + map.sessions[s].name;
  }
  throw InvalidOption(option, "'" + name + "'", "a session of the map: " + want);
}

ordered_json rounds_json(const std::vector<PersonRound>& rounds) {
  ordered_json list = ordered_json::array();
  for (const PersonRound& r : rounds)
    list.push_back({{"drawn", r.drawn},
                    {"put_right", r.put_right},
                    {"clicks", r.clicks},
                    {"people", r.people},
                    {"precision", r.precision},
                    {"recall", r.recall}});
  return list;
}

// Rounds of learning in the sessions whose truth is to play the labeller.
std::vector<PersonRound> learn(const DetectCommand& command,
                               const Map& map,
                               const std::vector<std::optional<Drive>>& drives,
                               const GroundModel& ground,
                               Console& console,
                               std::optional<PersonLearner>& learner) {
  std::vector<PersonRound> rounds;
  for (const std::string& name : command.oracle) {
    const std::size_t s = session_index(map, "--oracle", name);
    if (!drives[s])
      throw BadInput(Problem{Severity::kError, map.sessions[s].drive_path, 0, "drive",
                             "none at hand", "the simulated drive of session " + name});
    const PeopleTruth truth(*drives[s]);
    if (!truth.anybody()) console.note("session " + name + ": nobody there to learn from");
    const PeopleSession session(map, static_cast<int>(s), *drives[s], ground, command.options);
    if (!learner) learner.emplace(session.cameras(), command.options.learner);
    learner->set_cameras(session.cameras());
    const auto more = session.play(truth, *learner, rounds.empty() ? PersonRound{} : rounds.back(),
                                   console.progress());
    for (const PersonRound& r : more) {
      rounds.push_back(r);
      console.say("round " + std::to_string(rounds.size()) + ": " + std::to_string(r.people) +
                  " people in new images, precision " + fixed(r.precision, 3) + ", recall " +
                  fixed(r.recall, 3) + "; then " + std::to_string(r.drawn) + " drawn, " +
                  std::to_string(r.put_right) + " put right, " + std::to_string(r.clicks) +
                  " clicks");
    }
  }
  return rounds;
}

ordered_json score_json(const PeopleScore& score) {
  double chi2 = 0.0;
  for (const double m : score.mahalanobis2) chi2 += m;
  if (!score.mahalanobis2.empty()) chi2 /= static_cast<double>(score.mahalanobis2.size());
  return {{"people", score.people},         {"precision", score.precision()},
          {"recall", score.recall()},       {"foot_error_median_m", score.median_error_m()},
          {"foot_mahalanobis2_mean", chi2}, {"calibration_error", score.calibration_error()}};
}

// What is known beside what people taught in the map's own page.
PersonExamples known_examples(const DetectCommand& command) {
  PersonExamples examples;
  if (!command.from.empty()) {
    examples = joined(taught_examples(command.from), read_person_examples(MapLayers(command.from)));
    if (examples.size() == 0)
      throw BadInput(Problem{Severity::kError, command.from.string(), 0, "table person_examples",
                             "none", "a map in which people were learnt"});
  }
  if (command.anew) return examples;
  return joined(std::move(examples), read_person_examples(MapLayers(command.map)));
}

// What people taught stands in the map already, as labels.
PersonExamples without_first(const PersonExamples& examples,
                             std::size_t count,
                             std::size_t answer_count) {
  const auto first = static_cast<std::ptrdiff_t>(count);
  const auto first_answer = static_cast<std::ptrdiff_t>(answer_count);
  return {{examples.features.begin() + first, examples.features.end()},
          {examples.labels.begin() + first, examples.labels.end()},
          {examples.answers.begin() + first_answer, examples.answers.end()},
          examples.instants};
}

void replace(std::vector<SessionSightings>& all, SessionSightings one) {
  for (SessionSightings& old : all)
    if (old.session == one.session) {
      one.blockers = std::move(old.blockers);
      old = std::move(one);
      return;
    }
  all.push_back(std::move(one));
}

// Looks through one session: what was found goes to `all`, what there is to say of it is returned.
ordered_json find_in(const Map& map,
                     std::size_t s,
                     const Drive& drive,
                     const GroundModel& ground,
                     const PeopleDetectOptions& options,
                     PersonLearner& learner,
                     Console& console,
                     std::vector<SessionSightings>& all) {
  const std::string& name = map.sessions[s].name;
  const PeopleSession session(map, static_cast<int>(s), drive, ground, options);
  learner.set_cameras(session.cameras());
  std::optional<PeopleTruth> truth;
  if (std::filesystem::exists(drive.folder() / "truth" / "world.json")) truth.emplace(drive);
  PeopleScore score;
  SessionSightings found =
      session.find(learner, truth ? &*truth : nullptr, &score, console.progress());
  std::string line = name + ": " + std::to_string(found.detections.size()) + " sightings in " +
                     std::to_string(found.looks.size()) + " looks";
  ordered_json entry{
      {"session", name}, {"sightings", found.detections.size()}, {"looks", found.looks.size()}};
  if (truth) {
    entry["truth"] = score_json(score);
    line += "; precision " + fixed(score.precision(), 3) + ", recall " + fixed(score.recall(), 3) +
            " of " + std::to_string(score.people) + ", feet " + fixed(score.median_error_m(), 2) +
            " m (median)";
  }
  console.say(line);
  replace(all, std::move(found));
  return entry;
}

// Those asked for, or all; where a drive is at hand.
std::vector<std::size_t> sessions_at_hand(const std::vector<std::size_t>& asked,
                                          const std::vector<std::optional<Drive>>& drives) {
  std::vector<std::size_t> sessions = asked;
  for (std::size_t s = 0; asked.empty() && s < drives.size(); ++s) sessions.push_back(s);
  std::erase_if(sessions, [&](std::size_t s) { return !drives[s]; });
  return sessions;
}

// A learner of what is known, if anything is.
std::optional<PersonLearner> learner_of(PersonExamples examples,
                                        const PersonLearnerOptions& options) {
  if (examples.size() == 0) return std::nullopt;
  std::optional<PersonLearner> learner(std::in_place, std::vector<PersonCamera>{}, options);
  learner->start_from(std::move(examples));
  (void)learner->learn();
  return learner;
}

// What people taught in the page of the map.
struct Taught {
  std::size_t examples = 0;
  std::size_t answers = 0;
};

ordered_json detect_json(const std::vector<PersonRound>& rounds,
                         const PersonLearner& learner,
                         const Taught& taught,
                         ordered_json sessions,
                         const std::filesystem::path& map) {
  return {{"rounds", rounds_json(rounds)},
          {"examples", learner.examples().size()},
          {"taught", taught.examples},
          {"persons", learner.examples().positives()},
          {"answers", learner.examples().answers.size()},
          {"prior_shift", learner.classifier()->shift()},
          {"sessions", std::move(sessions)},
          {"digest", load_meta(map).digest}};
}

ExitStatus run_detect(DetectCommand command, Console& console, const CommonOptions& common) {
  command.options.learner.num_threads = common.threads;
  command.options.vehicle = given_vehicle(command.vehicle);
  MapUpdate update(command.map);  // nobody changes the map between reading and writing
  const Map map = load_map(command.map);
  std::vector<std::size_t> asked;
  for (const std::string& name : command.sessions)
    asked.push_back(session_index(map, "--session", name));
  const auto drives = open_session_drives(command.map, map, command.drives, console);
  GroundModelOptions ground_options;
  ground_options.reach_m = command.options.learner.search.max_range_m + 5.0;
  const GroundModel ground = estimate_ground(map, ground_options);
  PersonExamples examples = taught_examples(command.map);
  const Taught taught{examples.size(), examples.answers.size()};
  auto learner =
      learner_of(joined(std::move(examples), known_examples(command)), command.options.learner);
  const auto rounds = learn(command, map, drives, ground, console, learner);
  if (!learner || !learner->classifier())
    throw Refused("error: " + command.map.string() +
                  ": person_examples: got none, want people learnt (label -m MAP, --oracle "
                  "SESSION, --from MAP)");

  // The shift is right for all that a search brings up, and too strong for the sightings among it,
  // which the speed map counts (docs/guide/people.md).
  learner->use_prior_of_searches(command.options.min_probability.has_value(), taught.answers);
  std::vector<SessionSightings> all = stored_sightings(MapLayers(command.map), map);
  ordered_json sessions = ordered_json::array();
  for (const std::size_t s : sessions_at_hand(asked, drives))
    sessions.push_back(
        find_in(map, s, *drives[s], ground, command.options, *learner, console, all));
  write_sightings(update, all);
  write_people_layer(update, map, ground, all);
  write_person_examples(update,
                        without_first(learner->examples(), taught.examples, taught.answers));
  update.note("detect", std::to_string(sessions.size()) + " sessions");
  update.commit();
  console.result(detect_json(rounds, *learner, taught, std::move(sessions), command.map));
  return ExitStatus::kDone;
}

void add_detect_options(Options& options, DetectCommand& command) {
  PeopleDetectOptions& o = command.options;
  options.add("--map,-m", &command.map, "map file").required = true;
  add_drive_option(options, &command.drives);
  add_vehicle_option(options, &command.vehicle);
  options.add("--session", &command.sessions,
              "session to look through; default: all whose drive is at hand");
  options.add("--oracle", &command.oracle,
              "session of a simulated drive whose truth plays the labeller");
  options.add("--from", &command.from, "another map, whose learnt examples serve too");
  options.add("--anew", &command.anew,
              "forgets what earlier runs have learnt; what people taught in the page stays");
  options.add("--every-s", &o.every_s, "between two looks [s]").range = {0.01, 1.0};
  options
      .add("--probability", &o.min_probability,
           "of a sighting that counts; default: as like a person as not among what was learnt")
      .range = {0.01, 0.999};
  options
      .add("--max-range-m", &o.learner.search.max_range_m,
           "people are looked for out to here, from each camera [m]")
      .range = {2.0, 20.0};
  options.add("--seed", &o.learner.seed, "of the windows drawn by chance");
}

}  // namespace

Verb detect_verb() {
  auto command = std::make_shared<DetectCommand>();
  return {"detect", "finds people in the images of a map's sessions",
          [command](Options& options) { add_detect_options(options, *command); },
          [command](Console& console, const CommonOptions& common) {
            return run_detect(*command, console, common);
          }};
}

}  // namespace roadbook
