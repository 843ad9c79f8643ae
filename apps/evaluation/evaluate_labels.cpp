#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/evaluate.hpp"
#include "apps/evaluation/pictures/label_pictures.hpp"
#include "apps/evaluation/pictures/painted_lot.hpp"
#include "apps/report/chart.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"
#include "semantics/detector/gp_laplace.hpp"
#include "semantics/detector/label_oracle.hpp"
#include "workflows/labels/oracle_json.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

/// One policy for questions and negatives, applied to each floor.
struct Way {
  std::string name;
  QuestionPolicy questions;
  NegativePolicy negatives;
  bool dashed = false;
  std::vector<OracleResult> results{};
};

/// The predicted probability of the last unanswered hypotheses, and whether each was correct. It
/// pools all floors, because one floor has too few hypotheses.
struct Scored {
  std::vector<std::pair<double, bool>> with_prior{};
  std::vector<std::pair<double, bool>> without{};

  void add(const BoxLearner& learner, const std::vector<OrientedBox>& truth, double same_overlap) {
    std::vector<OrientedBox> boxes;
    for (const Hypothesis& h : learner.hypotheses()) boxes.push_back(h.box);
    const auto match = match_boxes(boxes, truth, same_overlap);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const double said = learner.hypotheses()[i].prediction.probability;
      const double before = logistic(logit_of(said) - learner.classifier()->shift());
      if (before < 0.01) continue;  // the many clear negatives would dominate the curve
      with_prior.emplace_back(said, match[i] >= 0);
      without.emplace_back(before, match[i] >= 0);
    }
  }
};

/// A floor labelled with the examples of the previous floor, compared with the same floor labelled
/// alone.
struct SecondFloor {
  double f1 = 0.0;  ///< of the floor alone, after its last round
  int drawn_alone = 0;
  int clicks_alone = 0;
  OracleResult after;
};

OracleOptions way_options(const Way& way, std::uint64_t seed, const EvaluateCommand& command) {
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

// Draws the mean f1 of the floors over the mean number of labels given.
ChartSeries label_curve(const Way& way) {
  ChartSeries series{way.name, {}, {}, way.dashed};
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

ordered_json way_json(const Way& way) {
  ordered_json floors = ordered_json::array();
  for (const OracleResult& result : way.results)
    floors.push_back({{"area_under_curve", result.area_under_curve()},
                      {"rounds", oracle_rounds_json(result.rounds)}});
  return {{"name", way.name}, {"floors", floors}};
}

// Returns the first round that is as good as the last round of the floor alone. Empty if there is
// no such round.
std::optional<OracleRound> first_as_good(const SecondFloor& floor) {
  for (const OracleRound& round : floor.after.rounds)
    if (round.f1 >= floor.f1) return round;
  return std::nullopt;
}

ordered_json second_floor_json(const std::vector<SecondFloor>& floors) {
  ordered_json list = ordered_json::array();
  for (const SecondFloor& floor : floors) {
    ordered_json entry{{"f1", floor.f1},
                       {"drawn_alone", floor.drawn_alone},
                       {"clicks_alone", floor.clicks_alone},
                       {"rounds", oracle_rounds_json(floor.after.rounds)}};
    if (const auto round = first_as_good(floor)) {
      entry["drawn"] = round->drawn;
      entry["put_right"] = round->put_right;
      entry["clicks"] = round->clicks;
    }
    list.push_back(entry);
  }
  return list;
}

OracleResult play_second_floor(const PaintedLot& lot,
                               const Way& way,
                               std::uint64_t seed,
                               const EvaluateCommand& command,
                               const BoxExamples& taught) {
  OracleOptions options = way_options(way, seed, command);
  options.start = taught;
  options.first_boxes = 0;
  options.boxes_a_round = 1;
  options.max_boxes = 3 * options.max_boxes / 10;  // as a share of the limit for the floor alone
  return play_oracle(lot.image, lot.spaces, options);
}

// Returns the mean effort for a floor after its last round.
std::string mean_effort(const Way& way) {
  OracleRound sum;
  for (const OracleResult& result : way.results) {
    sum.drawn += result.rounds.back().drawn;
    sum.put_right += result.rounds.back().put_right;
    sum.clicks += result.rounds.back().clicks;
  }
  const auto mean = [&](int count) {
    return fixed(static_cast<double>(count) / static_cast<double>(way.results.size()), 1);
  };
  return mean(sum.drawn) + " boxes drawn, " + mean(sum.put_right) + " put right, " +
         mean(sum.clicks) + " clicks";
}

int times_better(const Way& a, const Way& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.results.size(); ++i)
    count += a.results[i].area_under_curve() > b.results[i].area_under_curve() ? 1 : 0;
  return count;
}

std::string label_page(const std::string& chart, const std::vector<Way>& ways) {
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
  html += "</table><p>Area under the curve of F1 over labels, drawn and clicked.</p><ul>";
  for (const Way& way : ways)
    html += "<li>" + way.name + ": a floor takes " + mean_effort(way) + "</li>";
  return html + "</ul>";
}

std::vector<Way> ways_of(bool quick) {
  std::vector<Way> ways{
      {"most telling, random negatives", QuestionPolicy::kTelling, NegativePolicy::kRandom},
      {"any, random negatives", QuestionPolicy::kRandom, NegativePolicy::kRandom, true},
      {"least sure, random negatives", QuestionPolicy::kUncertain, NegativePolicy::kRandom},
      {"most telling, rejected negatives", QuestionPolicy::kTelling, NegativePolicy::kRejected},
      {"any, rejected negatives", QuestionPolicy::kRandom, NegativePolicy::kRejected, true}};
  if (quick) ways.resize(2);
  return ways;
}

// Runs all ways on one floor. Then repeats the first way with the examples of the previous floor.
void play_floor(const EvaluateCommand& command,
                std::uint64_t seed,
                std::vector<Way>& ways,
                BoxExamples& taught,
                Scored& calibration,
                std::vector<SecondFloor>& second) {
  const PaintedLot lot =
      painted_lot("stuttgart", command.quick ? "small" : "full", seed, command.threads);
  const BoxExamples before = std::move(taught);
  for (std::size_t i = 0; i < ways.size(); ++i) {
    OracleOptions options = way_options(ways[i], seed, command);
    if (i == 0)
      options.after_round = [&, round = 0](const BoxLearner& learner) mutable {
        taught = learner.examples();
        if (++round == options.rounds) calibration.add(learner, lot.spaces, options.same_overlap);
      };
    ways[i].results.push_back(play_oracle(lot.image, lot.spaces, options));
  }
  if (before.empty()) return;
  const OracleRound& alone = ways[0].results.back().rounds.back();
  second.push_back({alone.f1, alone.drawn, alone.clicks,
                    play_second_floor(lot, ways[0], seed, command, before)});
}

void say_second_floors(const std::vector<SecondFloor>& second, Console& console) {
  int reached = 0;
  int drawn = 0;
  int alone = 0;
  for (const SecondFloor& floor : second) {
    const auto round = first_as_good(floor);
    reached += round ? 1 : 0;
    drawn += round ? round->drawn : floor.after.rounds.back().drawn;
    alone += floor.drawn_alone;
  }
  if (second.empty()) return;
  console.say("after another floor: " + std::to_string(drawn) + " boxes drawn where " +
              std::to_string(alone) + " were; as good on " + std::to_string(reached) + " of " +
              std::to_string(second.size()) + " floors");
}

// Writes and prints the results of all floors.
void conclude(Console& console,
              const EvaluateCommand& command,
              const std::vector<Way>& ways,
              const Scored& calibration,
              const std::vector<SecondFloor>& second) {
  const double with_prior = calibration_error(calibration.with_prior);
  const double without = calibration_error(calibration.without);
  const ChanceOfCalibration chance = chance_of_calibration(calibration.with_prior, command.seed);
  std::vector<ChartSeries> series;
  ordered_json list = ordered_json::array();
  for (const Way& way : ways) {
    series.push_back(label_curve(way));
    list.push_back(way_json(way));
  }
  const int better = times_better(ways[0], ways[1]);
  console.say("asking the most telling is better on " + std::to_string(better) + " of " +
              std::to_string(ways.front().results.size()) + " floors");
  console.say("a floor takes " + mean_effort(ways[0]) + " in the mean");
  console.say("calibration error of " + std::to_string(calibration.without.size()) +
              " hypotheses that nobody was asked about: " + fixed(with_prior, 3) + " (" +
              fixed(chance.mean, 3) + " by chance alone, up to " + fixed(chance.most, 3) +
              "), without the prior that answers tell " + fixed(without, 3));
  say_second_floors(second, console);
  const std::string chart = chart_svg({"Parking spaces found, mean over floors",
                                       "labels given (drawn and clicked)", "F1", 0.0, 1.0},
                                      series);
  const ordered_json json{{"experiment", "labels"},
                          {"seed", command.seed},
                          {"floors", ways.front().results.size()},
                          {"most_telling_better", better},
                          {"calibration_error",
                           {{"with_prior", with_prior},
                            {"without", without},
                            {"by_chance", {{"mean", chance.mean}, {"most", chance.most}}}}},
                          {"second_floor", second_floor_json(second)},
                          {"ways", list}};
  write_whole_file(command.out / "labels.svg", chart);
  write_whole_file(command.out / "labels.html", label_page(chart, ways));
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

void run_label_curves(Console& console, const EvaluateCommand& command) {
  if (!command.data.empty()) {
    evaluate_label_pictures(console, command);
    return;
  }
  std::vector<Way> ways = ways_of(command.quick);
  std::vector<SecondFloor> second;
  BoxExamples taught;
  Scored calibration;
  const int floors = command.repeats > 0 ? command.repeats : (command.quick ? 3 : 10);
  for (int floor = 0; floor < floors; ++floor) {
    play_floor(command, command.seed + static_cast<std::uint64_t>(floor), ways, taught, calibration,
               second);
    console.say("floor " + std::to_string(floor + 1) + ": area " +
                fixed(ways[0].results.back().area_under_curve(), 3) + " asking the most telling, " +
                fixed(ways[1].results.back().area_under_curve(), 3) + " asking any");
  }
  conclude(console, command, ways, calibration, second);
}

}  // namespace

Experiment labels_experiment() {
  return {"labels",
          "quality of the label detector by the number of labels, for each choice of questions and "
          "negatives (metric-semantic maps, figure 7)",
          run_label_curves};
}

}  // namespace roadbook
