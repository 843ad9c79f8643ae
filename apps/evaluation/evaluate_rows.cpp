#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "apps/evaluation/rows_study.hpp"
#include "base/error.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr int kSeeds = 6;

std::vector<RowsDrive> rows_drives(bool quick) {
  if (quick) {
    const RowsDrive open{.name = "small, open",
                         .scenario = "stuttgart",
                         .size = "small",
                         .seconds = 15.0,
                         .image_scale = 0.5};
    RowsDrive closed = open;
    closed.name = "small, closed";
    closed.seconds = 36.0;  // one and a third laps
    return {open, closed};
  }
  const EffectSizes wheel{{"wheels0.left_radius", 0.01}};
  return {
      {.name = "open", .scenario = "stuttgart", .seconds = 30.0},
      {.name = "640x480, open", .scenario = "stuttgart", .seconds = 30.0, .image_scale = 0.5},
      {.name = "left wheel 1 % larger", .scenario = "stuttgart", .seconds = 30.0, .effects = wheel},
      {.name = "two sessions", .scenario = "stuttgart", .visits = 2, .seconds = 30.0},
      {.name = "closed", .scenario = "stuttgart", .seconds = 95.0},
      {.name = "zurich, closed", .scenario = "zurich"}};
}

// Only the first drive has the labels with irregular rows.
std::vector<RowsLabels> rows_labels(bool first) {
  std::vector<RowsLabels> kinds{{.name = "drawn"}, {.name = "found", .sigma_m = 0.12}};
  if (!first) return kinds;
  kinds.push_back({.name = "one space 10 % wider", .wider = 0.1});
  kinds.push_back({.name = "rows of 1 km radius", .radius_m = 1000.0});
  kinds.push_back({.name = "rows turn by 1 degree", .kink_rad = 0.01745});
  kinds.push_back({.name = "spaces 10 cm off", .uneven_m = 0.1});
  return kinds;
}

/// Results of one drive and one kind of labels, over the seeds.
struct RowsTally {
  std::vector<double> ate_off, ate_on, label_off, label_on;
  std::vector<double> ate_ratio, label_ratio;
  EqualRowsUsed used;

  void add(const RowsOutcome& outcome) {
    ate_off.push_back(outcome.off.ate_rmse_m);
    ate_on.push_back(outcome.on.ate_rmse_m);
    label_off.push_back(outcome.off.label_rmse_m);
    label_on.push_back(outcome.on.label_rmse_m);
    ate_ratio.push_back(ate_on.back() / ate_off.back());
    label_ratio.push_back(label_on.back() / label_off.back());
    used.rows += outcome.used.rows;
    used.spaces += outcome.used.spaces;
    used.refused += outcome.used.refused;
  }
};

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::string with_interval(const RatioInterval& r) {
  return fixed(r.ratio, 2) + " (" + fixed(r.low, 2) + " to " + fixed(r.high, 2) + ")";
}

ordered_json errors_json(const std::vector<double>& off,
                         const std::vector<double>& on,
                         const std::vector<double>& ratios) {
  const RatioInterval r = ratio_interval(ratios);
  ordered_json json{{"off_m", off}, {"on_m", on}, {"ratio", r.ratio}};
  if (ratios.size() > 1) json["interval95"] = {r.low, r.high};
  return json;
}

ordered_json tally_json(const std::string& drive, const std::string& labels, const RowsTally& t) {
  return {{"drive", drive},
          {"labels", labels},
          {"rows_used", t.used.rows},
          {"rows_refused", t.used.refused},
          {"ate_rmse", errors_json(t.ate_off, t.ate_on, t.ate_ratio)},
          {"label_rmse", errors_json(t.label_off, t.label_on, t.label_ratio)}};
}

void say_tally(const std::string& drive,
               const std::string& labels,
               const RowsTally& t,
               Console& console) {
  console.say(
      drive + "; " + labels + ": ATE " + fixed(100.0 * mean_of(t.ate_off), 2) + " -> " +
      fixed(100.0 * mean_of(t.ate_on), 2) + " cm, ratio " +
      with_interval(ratio_interval(t.ate_ratio)) + "; labels " +
      fixed(100.0 * mean_of(t.label_off), 2) + " -> " + fixed(100.0 * mean_of(t.label_on), 2) +
      " cm, ratio " + with_interval(ratio_interval(t.label_ratio)) + "; rows " +
      std::to_string(t.used.rows) + " used, " + std::to_string(t.used.refused) + " refused");
  std::cout.flush();
}

// Prints each result when it is complete, because all results take long.
void say_seed(const std::string& drive,
              std::uint64_t seed,
              const RowsOutcome& o,
              Console& console) {
  console.say(
      drive + "; " + o.labels + "; seed " + std::to_string(seed) + ": ATE " +
      fixed(100.0 * o.off.ate_rmse_m, 2) + " -> " + fixed(100.0 * o.on.ate_rmse_m, 2) + " cm; " +
      std::to_string(o.labelled) + " labels " + fixed(100.0 * o.off.label_rmse_m, 2) + " -> " +
      fixed(100.0 * o.on.label_rmse_m, 2) + " cm; rows " + std::to_string(o.used.rows) + " used (" +
      std::to_string(o.used.spaces) + " spaces), " + std::to_string(o.used.refused) + " refused");
  std::cout.flush();
}

ordered_json run_drive(const RowsDrive& drive,
                       const std::vector<RowsLabels>& kinds,
                       int seeds,
                       Console& console,
                       const EvaluateCommand& command) {
  std::vector<RowsTally> tallies(kinds.size());
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = command.seed + static_cast<std::uint64_t>(i);
    const auto outcomes = study_rows(drive, kinds, seed, command.threads, console.progress());
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      tallies[k].add(outcomes[k]);
      say_seed(drive.name, seed, outcomes[k], console);
    }
  }
  ordered_json list = ordered_json::array();
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (seeds > 1) say_tally(drive.name, kinds[k].name, tallies[k], console);
    list.push_back(tally_json(drive.name, kinds[k].name, tallies[k]));
  }
  return list;
}

void run_rows(Console& console, const EvaluateCommand& command) {
  const int seeds = command.repeats > 0 ? command.repeats : command.quick ? 2 : kSeeds;
  const std::vector<RowsDrive> drives = rows_drives(command.quick);
  if (std::none_of(drives.begin(), drives.end(),
                   [&](const RowsDrive& d) { return d.name.starts_with(command.only); })) {
    std::string names;
    for (const RowsDrive& d : drives) names += (names.empty() ? "" : "; ") + d.name;
    throw InvalidOption("--only", "'" + command.only + "'",
                        "what the name of a drive begins with: " + names);
  }
  ordered_json cases = ordered_json::array();
  for (std::size_t d = 0; d < drives.size(); ++d) {
    if (!drives[d].name.starts_with(command.only)) continue;
    const auto kinds = rows_labels(d == 0 && !command.quick);
    for (auto& one : run_drive(drives[d], kinds, seeds, console, command)) cases.push_back(one);
  }
  const ordered_json json{
      {"experiment", "rows"}, {"seed", command.seed}, {"seeds", seeds}, {"cases", cases}};
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment rows_experiment() {
  return {"rows",
          "accuracy of a map with and without --equal-rows (--only: beginnings of drive names)",
          run_rows};
}

}  // namespace roadbook
