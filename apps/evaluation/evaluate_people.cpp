#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "apps/evaluation/people_study.hpp"
#include "apps/evaluation/speed_evolution.hpp"
#include "apps/report/chart.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

double mean_value(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

ordered_json visit_json(const PeopleVisit& visit) {
  ordered_json rounds = ordered_json::array();
  for (const PersonRound& r : visit.rounds)
    rounds.push_back({{"drawn", r.drawn},
                      {"put_right", r.put_right},
                      {"clicks", r.clicks},
                      {"people", r.people},
                      {"precision", r.precision},
                      {"recall", r.recall}});
  return {{"visit", visit.visit},
          {"people", visit.score.people},
          {"precision", visit.score.precision()},
          {"recall", visit.score.recall()},
          {"foot_error_median_m", visit.score.median_error_m()},
          {"foot_mahalanobis2_mean", mean_value(visit.score.mahalanobis2)},
          {"find_s", visit.find_s},
          {"calibration_error", visit.score.calibration_error()},
          {"held_out",
           {{"people", visit.held_out.people},
            {"precision", visit.held_out.precision()},
            {"recall", visit.held_out.recall()},
            {"calibration_error", visit.held_out.calibration_error()}}},
          {"rounds", rounds}};
}

std::string people_chart(const std::vector<PeopleVisit>& visits) {
  ChartSeries precision{"precision", {}, {}, false};
  ChartSeries recall{"recall", {}, {}, false};
  for (const PeopleVisit& visit : visits) {
    precision.points.emplace_back(visit.visit, visit.held_out.precision());
    recall.points.emplace_back(visit.visit, visit.held_out.recall());
  }
  return chart_svg({"People found on another day", "revisits learnt from", "", 0.0, 1.0},
                   {precision, recall});
}

std::string evolution_chart(const SpeedEvolution& found, const SpeedEvolution& truth) {
  return chart_svg({"Presence where the crossings meet the lanes: people found, and as they were",
                    "revisits in the map", "presence", 0.0, 0.6},
                   {series_by_number("right, found", found.right, false),
                    series_by_number("left, found", found.left, false),
                    series_by_number("right, true", truth.right, true),
                    series_by_number("left, true", truth.left, true)});
}

// Prints each visit when it is complete, because all visits take half an hour.
void say_visit(const PeopleVisit& visit, Console& console) {
  const PersonRound last = visit.rounds.empty() ? PersonRound{} : visit.rounds.back();
  console.say("revisit " + std::to_string(visit.visit) + ": " + std::to_string(visit.score.people) +
              " people, precision " + fixed(visit.score.precision(), 3) + ", recall " +
              fixed(visit.score.recall(), 3) + ", feet " + fixed(visit.score.median_error_m(), 2) +
              " m (median); then " + std::to_string(last.drawn) + " boxes, " +
              std::to_string(last.clicks) + " clicks so far; held out: precision " +
              fixed(visit.held_out.precision(), 3) + ", recall " +
              fixed(visit.held_out.recall(), 3) + " of " + std::to_string(visit.held_out.people));
}

void run_people(Console& console, const EvaluateCommand& command) {
  PeopleStudyOptions options;
  options.seed = command.seed;
  options.detect.learner.num_threads = command.threads;
  options.small = command.quick;
  options.step_s = command.quick ? 0.6 : 0.8;
  if (command.repeats > 0) options.visits = command.repeats;
  options.after_visit = [&](const PeopleVisit& visit) {
    say_visit(visit, console);
    std::cout.flush();
  };
  const std::vector<PeopleVisit> visits = study_people(options, console.progress());
  ordered_json list = ordered_json::array();
  for (const PeopleVisit& visit : visits) list.push_back(visit_json(visit));
  ordered_json json{{"experiment", "people"}, {"seed", command.seed}, {"visits", list}};
  write_whole_file(command.out / "people.svg", people_chart(visits));
  if (!command.quick) {
    // The first revisit is for learning. In the map it has the people that a labeller saw.
    std::vector<std::vector<VisitFrame>> seen(1);
    for (const PeopleVisit& visit : visits) seen.push_back(visit.frames);
    const SpeedEvolution found = zurich_evolution({}, {}, command.seed, seen);
    const SpeedEvolution truth = zurich_evolution({}, {}, command.seed);
    write_whole_file(command.out / "presence.svg", evolution_chart(found, truth));
    json["presence"] = {{"right", found.right},    {"left", found.left},
                        {"lanes", found.lanes},    {"right_true", truth.right},
                        {"left_true", truth.left}, {"lanes_true", truth.lanes}};
  }
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment people_experiment() {
  return {"people",
          "detection of people in fisheye images, better with each revisit "
          "(metric-semantic maps, section VI-B)",
          run_people};
}

}  // namespace roadbook
