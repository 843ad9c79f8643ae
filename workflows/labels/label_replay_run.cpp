#include "workflows/labels/label_replay_run.hpp"

#include <nlohmann/json.hpp>

#include "mapping/store/map_file.hpp"
#include "workflows/labels/label_examples.hpp"
#include "workflows/labels/label_place.hpp"
#include "workflows/labels/people_training.hpp"
#include "workflows/labels/round_replay.hpp"
#include "workflows/people/people_detect.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

std::string verdict(const std::string& classifier, const std::string& now) {
  return now == classifier ? "same classifier" : "different classifier: " + now;
}

std::string ground_verdict(const LearningRound& round,
                           const std::string& basis,
                           const std::string& now) {
  if (round.basis.empty()) return "not compared: the round stores no digest of its inputs";
  if (round.basis != basis)
    return "not compared: poses, overhead image or examples of other maps have changed";
  return verdict(round.classifier, now);
}

std::string people_verdict(const PeopleRound& round, const ReplayedRound& now) {
  if (round.basis.empty()) return "not compared: the round stores no digest of its inputs";
  if (round.basis != now.basis)
    return "not compared: recordings, cameras or examples of other maps have changed";
  if (!now.follows) return "not compared: an earlier round cannot be repeated";
  return verdict(round.classifier, now.classifier.value_or(""));
}

// Adds the result of the repetition to the entry of a round. The value is null if the round could
// not be repeated.
ordered_json with_replayed(ordered_json entry,
                           const std::string& classifier,
                           const std::optional<std::string>& now,
                           bool& all_same) {
  entry["classifier"] = classifier;
  entry["replayed"] = nullptr;
  entry["same"] = nullptr;
  if (!now) return entry;
  entry["replayed"] = *now;
  entry["same"] = *now == classifier;
  all_same = all_same && *now == classifier;
  return entry;
}

ordered_json replay_ground(const std::filesystem::path& map,
                           const Map& poses,
                           const LabelPlace& place,
                           const std::vector<LabelEvent>& events,
                           int num_threads,
                           const Messages& messages,
                           bool& all_same) {
  const auto rounds = record_from_text(place.learnt_record).rounds;
  ExamplesByKind taught = stored_examples(map);
  BoxLearnerOptions options;
  options.search.num_threads = num_threads;
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    const LearningRound& round = rounds[i];
    const std::string basis = round_basis(poses, place.image, taught[round.kind]);
    std::optional<std::string> now;
    if (round.basis == basis)
      now = replayed_classifier(poses, place.image, taught[round.kind], options, events, rounds, i);
    messages.say("round " + std::to_string(round.number) + ", " + round.kind + ", " +
                 std::to_string(round.event) + " changes: classifier " + round.classifier + ", " +
                 ground_verdict(round, basis, now.value_or("")));
    list.push_back(with_replayed({{"round", round.number},
                                  {"class", round.kind},
                                  {"event", round.event},
                                  {"drawn_or_accepted", round.positives},
                                  {"rejected", round.negatives}},
                                 round.classifier, now, all_same));
  }
  return list;
}

ordered_json replay_people(const PeopleImages& images,
                           const LabelPlace& place,
                           const std::vector<LabelEvent>& events,
                           const PersonLearnerOptions& options,
                           const Messages& messages,
                           bool& all_same) {
  const auto& rounds = place.people_record.rounds;
  const auto replayed = replayed_people(images, place.people, options, events, rounds);
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    const PeopleRound& round = rounds[i];
    messages.say("round " + std::to_string(round.number) + ", people, " +
                 std::to_string(round.event) + " changes: classifier " + round.classifier + ", " +
                 people_verdict(round, replayed[i]));
    list.push_back(with_replayed({{"round", round.number},
                                  {"event", round.event},
                                  {"persons", round.persons},
                                  {"nobody", round.nobody},
                                  {"again", round.again}},
                                 round.classifier, replayed[i].classifier, all_same));
  }
  return list;
}

}  // namespace

ordered_json run_replay(const std::filesystem::path& map,
                        const std::vector<std::filesystem::path>& given_drives,
                        int num_threads,
                        const Messages& messages) {
  const LabelPlace place = read_label_place(map);
  const bool any_of_people = !place.people_record.rounds.empty();
  if (record_from_text(place.learnt_record).rounds.empty() && !any_of_people)
    throw BadInput(Problem{Severity::kError, map.string(), 0, "rounds", "none",
                           "at least one training round (roadbook label -m MAP)"});
  const Map poses = load_map(map);
  const auto events = read_label_events(map);
  bool all_same = true;
  const ordered_json ground =
      replay_ground(map, poses, place, events, num_threads, messages, all_same);
  ordered_json people = ordered_json::array();
  if (any_of_people) {
    PeopleDetectOptions options;
    options.learner.num_threads = num_threads;
    const auto drives = open_session_drives(map, poses, given_drives, messages);
    const PeopleImages images(&poses, &drives, options.learner, options.every_s);
    people = replay_people(images, place, events, options.learner, messages, all_same);
  }
  return {{"rounds", ground}, {"people", people}, {"same", all_same}};
}

}  // namespace roadbook
