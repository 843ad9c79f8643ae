#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "apps/evaluation/localisation/localisation_study.hpp"
#include "apps/summaries/localise_summary.hpp"
#include "base/format.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

ordered_json starts_json(const StartTally& t) {
  return {{"starts", t.starts},
          {"right", t.right},
          {"late", t.late},
          {"wrong", t.wrong},
          {"lost", t.lost},
          {"find_ms", t.mean_try_ms},
          {"largest_ms", t.largest_try_ms}};
}

std::string starts_line(const StartTally& t) {
  return std::to_string(t.starts) + " starts: " + std::to_string(t.right) +
         " right within 2.5 m, " + std::to_string(t.late) + " later, " + std::to_string(t.lost) +
         " lost, " + std::to_string(t.wrong) + " wrong; " + fixed(t.mean_try_ms, 0) +
         " ms of one core, " + fixed(t.largest_try_ms, 0) + " ms at most";
}

void run_localisation(Console& console, const EvaluateCommand& command) {
  LocalisationStudyOptions options;
  options.places = {"zurich", "stuttgart"};
  if (!command.only.empty()) {
    options.places.clear();
    for (const std::string_view place : split(command.only))
      options.places.emplace_back(trim(place));
  }
  options.seed = command.seed;
  options.num_threads = command.threads;
  if (command.quick) {
    options.size = "small";
    options.image_scale = 0.5;
    options.starts = 50;
  }
  if (command.repeats > 0) options.starts = static_cast<std::size_t>(command.repeats);
  const LocalisationStudy study = localisation_study(command.out, options, console.progress());
  ordered_json visits = ordered_json::array();
  for (const VisitFigures& v : study.visits) {
    const std::string name = v.place + ", visit " + std::to_string(v.visit) + ": ";
    for (const std::string& line : localisation_lines(v.drive)) console.say(name + line);
    console.say(name + starts_line(v.starts));
    ordered_json json{{"place", v.place}, {"visit", v.visit}};
    json.update(to_json(v.drive));
    json["random_starts"] = starts_json(v.starts);
    visits.push_back(std::move(json));
  }
  ordered_json foreign = ordered_json::array();
  for (const ForeignFigures& f : study.foreign) {
    console.say(f.place + " in the map of " + f.map + ": " + starts_line(f.starts));
    foreign.push_back(
        {{"place", f.place}, {"map", f.map}, {"random_starts", starts_json(f.starts)}});
  }
  const ordered_json json{{"experiment", "localisation"},
                          {"seed", command.seed},
                          {"visits", visits},
                          {"foreign", foreign}};
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment localisation_experiment() {
  return {"localisation",
          "later visits in the map of the first one, and random starts without a guess (--repeats: "
          "starts a visit, --only: built-in places, several with commas); drives and maps stay in "
          "the folder and are used again",
          run_localisation};
}

}  // namespace roadbook
