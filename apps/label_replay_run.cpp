#include "apps/label_replay_run.hpp"

#include <nlohmann/json.hpp>

#include "apps/label_examples.hpp"
#include "apps/label_server/label_place.hpp"
#include "apps/label_server/round_replay.hpp"
#include "mapping/map_file.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

std::string verdict(const LearningRound& round, const std::string& basis, const std::string& now) {
  if (round.basis.empty()) return "not told by the program that it ran in";
  if (round.basis != basis) return "poses, picture or what came from another place are others now";
  return now == round.classifier ? "the same again" : "another now: " + now;
}

}  // namespace

bool run_replay(const std::filesystem::path& map, int num_threads, Console& console) {
  const LabelPlace place = read_label_place(map);
  const auto rounds = record_from_text(place.learnt_record).rounds;
  if (rounds.empty())
    throw BadInput(Problem{Severity::kError, map.string(), 0, "rounds", "none",
                           "some, learnt in the page (roadbook label -m MAP)"});
  const Map poses = load_map(map);
  const auto events = read_label_events(map);
  ExamplesByKind taught = stored_examples(map);
  BoxLearnerOptions options;
  options.search.num_threads = num_threads;
  bool all_same = true;
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    const LearningRound& round = rounds[i];
    const std::string basis = round_basis(poses, place.image, taught[round.kind]);
    ordered_json entry = {{"round", round.number},       {"class", round.kind},
                          {"event", round.event},        {"drawn_or_accepted", round.positives},
                          {"rejected", round.negatives}, {"classifier", round.classifier},
                          {"replayed", nullptr},         {"same", nullptr}};
    std::string now;
    if (round.basis == basis) {
      now = replayed_classifier(poses, place.image, taught[round.kind], options, events, rounds, i);
      entry["replayed"] = now;
      entry["same"] = now == round.classifier;
      all_same = all_same && now == round.classifier;
    }
    console.say("round " + std::to_string(round.number) + ", " + round.kind + ", " +
                std::to_string(round.event) + " changes: classifier " + round.classifier + ", " +
                verdict(round, basis, now));
    list.push_back(entry);
  }
  console.result({{"rounds", list}, {"same", all_same}});
  return all_same;
}

}  // namespace roadbook
