#include "workflows/detect_people.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/format.hpp"
#include "mapping/pieces.hpp"
#include "mapping/store/map_file.hpp"
#include "workflows/people/people_store.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

std::size_t session_index(const Map& map, const char* option, const std::string& name) {
  std::string want;
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    if (map.sessions[s].name == name) return s;
    want += (want.empty() ? "" : ", ") + map.sessions[s].name;
  }
  throw InvalidOption(option, "'" + name + "'", "a session of the map: " + want);
}

// Runs rounds of training in the sessions in which the truth gives the answers.
std::vector<PersonRound> learn(const DetectRequest& request,
                               const Map& map,
                               const std::vector<std::optional<Drive>>& drives,
                               const GroundModel& ground,
                               Messages& messages,
                               std::optional<PersonLearner>& learner) {
  std::vector<PersonRound> rounds;
  for (const std::string& name : request.oracle) {
    const std::size_t s = session_index(map, "--oracle", name);
    if (!drives[s])
      throw BadInput(Problem{Severity::kError, map.sessions[s].drive_path, 0, "drive",
                             "none at hand", "the simulated drive of session " + name});
    const PeopleTruth truth(*drives[s]);
    if (!truth.has_people()) messages.note("session " + name + ": nobody there to learn from");
    const PeopleSession session(map, static_cast<int>(s), *drives[s], ground, request.options);
    if (!learner) learner.emplace(session.cameras(), request.options.learner);
    learner->set_cameras(session.cameras());
    const auto more = session.play(truth, *learner, rounds.empty() ? PersonRound{} : rounds.back(),
                                   messages.progress());
    for (const PersonRound& r : more) {
      rounds.push_back(r);
      messages.say("round " + std::to_string(rounds.size()) + ": " + std::to_string(r.people) +
                   " people in new images, precision " + fixed(r.precision, 3) + ", recall " +
                   fixed(r.recall, 3) + "; then " + std::to_string(r.drawn) + " drawn, " +
                   std::to_string(r.put_right) + " put right, " + std::to_string(r.clicks) +
                   " clicks");
    }
  }
  return rounds;
}

// Examples other than those of the map's own labelling page.
PersonExamples known_examples(const DetectRequest& request) {
  PersonExamples examples;
  if (!request.from.empty()) {
    examples = joined(request.taught_examples(request.from),
                      read_person_examples(MapLayers(request.from)));
    if (examples.size() == 0)
      throw BadInput(Problem{Severity::kError, request.from.string(), 0, "table person_examples",
                             "none", "a map in which people were learnt"});
  }
  if (request.anew) return examples;
  return joined(std::move(examples), read_person_examples(MapLayers(request.map)));
}

// The map already has the examples of its labelling page, as labels. These come first, and the
// function cuts them off.
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

// Searches one session: detections go to `all`.
SessionDetections find_in(const Map& map,
                          std::size_t s,
                          const Drive& drive,
                          const GroundModel& ground,
                          const PeopleDetectOptions& options,
                          PersonLearner& learner,
                          Messages& messages,
                          std::vector<SessionSightings>& all) {
  const std::string& name = map.sessions[s].name;
  const PeopleSession session(map, static_cast<int>(s), drive, ground, options);
  learner.set_cameras(session.cameras());
  std::optional<PeopleTruth> truth;
  if (std::filesystem::exists(drive.folder() / "truth" / "world.json")) truth.emplace(drive);
  PeopleScore score;
  SessionSightings found =
      session.find(learner, truth ? &*truth : nullptr, &score, messages.progress());
  std::string line = name + ": " + std::to_string(found.detections.size()) + " sightings in " +
                     std::to_string(found.looks.size()) + " looks";
  SessionDetections entry{name, found.detections.size(), found.looks.size(), std::nullopt};
  if (truth) {
    entry.score = score;
    line += "; precision " + fixed(score.precision(), 3) + ", recall " + fixed(score.recall(), 3) +
            " of " + std::to_string(score.people) + ", feet " + fixed(score.median_error_m(), 2) +
            " m (median)";
  }
  messages.say(line);
  replace(all, std::move(found));
  return entry;
}

// Returns the requested sessions, or all sessions, whose drive is available.
std::vector<std::size_t> sessions_at_hand(const std::vector<std::size_t>& asked,
                                          const std::vector<std::optional<Drive>>& drives) {
  std::vector<std::size_t> sessions = asked;
  for (std::size_t s = 0; asked.empty() && s < drives.size(); ++s) sessions.push_back(s);
  std::erase_if(sessions, [&](std::size_t s) { return !drives[s]; });
  return sessions;
}

// Returns a learner trained on `examples`. Returns nothing if there are no examples.
std::optional<PersonLearner> learner_of(PersonExamples examples,
                                        const PersonLearnerOptions& options) {
  if (examples.size() == 0) return std::nullopt;
  std::optional<PersonLearner> learner(std::in_place, std::vector<PersonCamera>{}, options);
  learner->start_from(std::move(examples));
  (void)learner->learn();
  return learner;
}

GroundModel ground_below_people(const Map& map, const PeopleDetectOptions& options) {
  GroundModelOptions ground;
  ground.reach_m = options.learner.search.max_range_m + 5.0;
  return estimate_ground(map, ground);
}

[[noreturn]] void refuse_without_examples(const std::filesystem::path& map) {
  throw Refused("error: " + map.string() +
                ": person_examples: got none, want people learnt (label -m MAP, --oracle "
                "SESSION, --from MAP)");
}

}  // namespace

DetectResult detect_people(const DetectRequest& request, Messages& messages) {
  MapUpdate update(request.map);  // locks the map between reading and writing
  const Map map = load_joined_map(request.map);
  std::vector<std::size_t> asked;
  for (const std::string& name : request.sessions)
    asked.push_back(session_index(map, "--session", name));
  const auto drives = open_session_drives(request.map, map, request.drives, messages);
  const GroundModel ground = ground_below_people(map, request.options);
  PersonExamples taught = request.taught_examples(request.map);
  DetectResult result;
  result.taught = taught.size();
  const std::size_t taught_answers = taught.answers.size();
  auto learner =
      learner_of(joined(std::move(taught), known_examples(request)), request.options.learner);
  result.rounds = learn(request, map, drives, ground, messages, learner);
  if (!learner || !learner->classifier()) refuse_without_examples(request.map);

  // The prior shift is correct for all hypotheses of a search. It is too strong for the detections
  // among them, which the speed map counts (docs/results/people.md).
  learner->use_prior_of_searches(request.options.min_probability.has_value(), taught_answers);
  std::vector<SessionSightings> all = stored_sightings(MapLayers(request.map), map);
  for (const std::size_t s : sessions_at_hand(asked, drives))
    result.sessions.push_back(
        find_in(map, s, *drives[s], ground, request.options, *learner, messages, all));
  write_sightings(update, all);
  write_people_layer(update, map, ground, all);
  write_person_examples(update, without_first(learner->examples(), result.taught, taught_answers));
  update.note("detect", std::to_string(result.sessions.size()) + " sessions");
  update.commit();
  result.examples = learner->examples().size();
  result.positives = learner->examples().positives();
  result.answers = learner->examples().answers.size();
  result.prior_shift = learner->classifier()->shift();
  result.digest = load_meta(request.map).digest;
  return result;
}

}  // namespace roadbook
