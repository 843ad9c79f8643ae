#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "apps/format.hpp"
#include "apps/painted_lot.hpp"
#include "apps/report/chart.hpp"
#include "apps/write_file.hpp"
#include "semantics/label_oracle.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

/// One way of asking and of taking negatives, on every floor.
struct Way {
  std::string name;
  QuestionPolicy questions;
  NegativePolicy negatives;
  std::vector<OracleResult> results{};
};

OracleOptions oracle_options(const Way& way, std::uint64_t seed, const EvaluateCommand& command) {
  OracleOptions options;
  options.seed = options.learner.seed = seed;
  options.questions_a_round = 10;
  options.learner.questions = way.questions;
  options.learner.negatives = way.negatives;
  options.learner.search.num_threads = command.threads;
  if (command.quick) {
    options.first_boxes = 3;
    options.boxes_a_round = 1;
    options.max_boxes = 8;
  }
  return options;
}

// Mean of f1 over the floors by mean labels given.
ChartSeries curve(const Way& way) {
  ChartSeries series{way.name, {}, {}, way.questions == QuestionPolicy::kRandom};
  for (std::size_t r = 0; r < way.results.front().rounds.size(); ++r) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const OracleResult& result : way.results) {
      const OracleRound& round = result.rounds[r];
      sum += Eigen::Vector2d(round.drawn + round.clicks, round.f1);
    }
    series.points.emplace_back(sum / static_cast<double>(way.results.size()));
  }
  return series;
}

Json way_json(const Way& way) {
  Json floors = Json::array();
  for (const OracleResult& result : way.results) {
    Json rounds = Json::array();
    for (const OracleRound& r : result.rounds)
      rounds.push_back({{"drawn", r.drawn},
                        {"clicks", r.clicks},
                        {"precision", r.precision},
                        {"recall", r.recall},
                        {"f1", r.f1},
                        {"seconds", r.seconds}});
    floors.push_back({{"area_under_curve", result.area_under_curve()}, {"rounds", rounds}});
  }
  return {{"name", way.name}, {"floors", floors}};
}

int times_better(const Way& a, const Way& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.results.size(); ++i)
    count += a.results[i].area_under_curve() > b.results[i].area_under_curve() ? 1 : 0;
  return count;
}

std::string page(const std::string& chart, const std::vector<Way>& ways) {
  std::string html =
      "<!doctype html><meta charset=\"utf-8\"><title>Label curves</title>"
      "<style>body{font-family:sans-serif;max-width:60em;margin:2em auto}td,th{padding:.2em .8em;"
      "text-align:right}</style><h1>Label curves</h1>" +
      chart + "<table><tr><th>floor</th>";
  for (const Way& way : ways) html += "<th>" + way.name + "</th>";
  html += "</tr>";
  for (std::size_t i = 0; i < ways.front().results.size(); ++i) {
    html += "<tr><td>" + std::to_string(i + 1) + "</td>";
    for (const Way& way : ways)
      html += "<td>" + fixed(way.results[i].area_under_curve(), 3) + "</td>";
    html += "</tr>";
  }
  return html + "</table><p>Area under the curve of F1 over labels, drawn and clicked.</p>";
}

void run(Console& console, const EvaluateCommand& command) {
  std::vector<Way> ways{
      {"least sure, random negatives", QuestionPolicy::kUncertain, NegativePolicy::kRandom},
      {"any, random negatives", QuestionPolicy::kRandom, NegativePolicy::kRandom},
      {"least sure, rejected alone", QuestionPolicy::kUncertain, NegativePolicy::kRejected},
      {"any, rejected alone", QuestionPolicy::kRandom, NegativePolicy::kRejected}};
  if (command.quick) ways.resize(2);
  const int floors = command.repeats > 0 ? command.repeats : (command.quick ? 3 : 10);
  for (int floor = 0; floor < floors; ++floor) {
    const std::uint64_t seed = command.seed + static_cast<std::uint64_t>(floor);
    const PaintedLot lot =
        painted_lot("stuttgart", command.quick ? "small" : "full", seed, command.threads);
    for (Way& way : ways)
      way.results.push_back(play_oracle(lot.image, lot.spaces, oracle_options(way, seed, command)));
    console.say("floor " + std::to_string(floor + 1) + ": area " +
                fixed(ways[0].results.back().area_under_curve(), 3) + " asking the least sure, " +
                fixed(ways[1].results.back().area_under_curve(), 3) + " asking any");
  }
  std::vector<ChartSeries> series;
  Json list = Json::array();
  for (const Way& way : ways) {
    series.push_back(curve(way));
    list.push_back(way_json(way));
  }
  const int better = times_better(ways[0], ways[1]);
  console.say("asking the least sure is better on " + std::to_string(better) + " of " +
              std::to_string(floors) + " floors");
  const std::string chart = chart_svg({"Parking spaces found, mean over floors",
                                       "labels given (drawn and clicked)", "F1", 0.0, 1.0},
                                      series);
  const Json json{{"experiment", "labels"},
                  {"seed", command.seed},
                  {"floors", floors},
                  {"least_sure_better", better},
                  {"ways", list}};
  write_file(command.out / "labels.svg", chart);
  write_file(command.out / "labels.html", page(chart, ways));
  write_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment labels_experiment() {
  return {"labels",
          "what labels are worth, by what is asked and what counts as none (document 004, "
          "figure 7)",
          run};
}

}  // namespace roadbook
