#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "apps/evaluation/robustness/robustness_study.hpp"
#include "base/error.hpp"
#include "base/format.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr int kDrives = 3;

/// The drives with one fault.
struct FaultTally {
  std::string fault;
  std::vector<RobustnessRun> runs;

  [[nodiscard]] std::size_t count(RobustnessOutcome outcome) const {
    return static_cast<std::size_t>(std::count_if(
        runs.begin(), runs.end(), [&](const RobustnessRun& r) { return r.outcome == outcome; }));
  }
  [[nodiscard]] std::size_t named() const {
    return static_cast<std::size_t>(
        std::count_if(runs.begin(), runs.end(), [](const RobustnessRun& r) { return r.is_named; }));
  }
  [[nodiscard]] std::size_t named_with_cause() const {
    return static_cast<std::size_t>(std::count_if(
        runs.begin(), runs.end(), [](const RobustnessRun& r) { return r.names_cause; }));
  }
  /// NaN without a map.
  [[nodiscard]] double largest_ratio() const {
    double largest = std::nan("");
    for (const RobustnessRun& run : runs)
      if (std::isnan(largest) || run.error_ratio > largest) largest = run.error_ratio;
    return largest;
  }
};

std::vector<DriveFault> chosen_faults(const std::string& only) {
  std::vector<DriveFault> all = wheel_faults();
  for (DriveFault& fault : camera_faults()) all.push_back(std::move(fault));
  if (only.empty()) return all;
  std::vector<DriveFault> chosen;
  for (const DriveFault& fault : all)
    for (const std::string_view beginning : split(only))
      if (fault.name.starts_with(beginning)) {
        chosen.push_back(fault);
        break;
      }
  if (!chosen.empty()) return chosen;
  std::string names;
  for (const DriveFault& fault : all) names += (names.empty() ? "" : "; ") + fault.name;
  throw InvalidOption("--only", "'" + only + "'", "what names of faults begin with: " + names);
}

ordered_json number_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json run_json(const RobustnessRun& run) {
  return {{"seed", run.seed},
          {"outcome", name_of(run.outcome)},
          {"named", run.is_named},
          {"cause_named", run.names_cause},
          {"error_ratio", number_or_null(run.error_ratio)},
          {"mapped_share", run.mapped_share},
          {"messages", run.messages}};
}

ordered_json fault_json(const FaultTally& tally) {
  ordered_json runs = ordered_json::array();
  for (const RobustnessRun& run : tally.runs) runs.push_back(run_json(run));
  return {{"fault", tally.fault},
          {"drives", tally.runs.size()},
          {"right", tally.count(RobustnessOutcome::kRight)},
          {"refused", tally.count(RobustnessOutcome::kRefused)},
          {"refused_not_named", tally.count(RobustnessOutcome::kRefusedElse)},
          {"wrong_said", tally.count(RobustnessOutcome::kWrongSaid)},
          {"wrong_silent", tally.count(RobustnessOutcome::kWrongSilent)},
          {"named", tally.named()},
          {"cause_named", tally.named_with_cause()},
          {"largest_error_ratio", number_or_null(tally.largest_ratio())},
          {"runs", runs}};
}

void say_fault(const FaultTally& tally, Console& console) {
  const std::string drives = " of " + std::to_string(tally.runs.size());
  console.say(tally.fault + ": right " + std::to_string(tally.count(RobustnessOutcome::kRight)) +
              ", refused " + std::to_string(tally.count(RobustnessOutcome::kRefused)) +
              ", refused without the sensor " +
              std::to_string(tally.count(RobustnessOutcome::kRefusedElse)) + ", wrong but said " +
              std::to_string(tally.count(RobustnessOutcome::kWrongSaid)) + ", wrong and silent " +
              std::to_string(tally.count(RobustnessOutcome::kWrongSilent)) + drives + "; named " +
              std::to_string(tally.named()) + drives + ", cause named " +
              std::to_string(tally.named_with_cause()) + drives + "; largest error " +
              fixed(tally.largest_ratio(), 1) + " times that of the clean drive");
  std::cout.flush();
}

void say_clean(const CleanRun& clean, Console& console) {
  console.say("clean drive, seed " + std::to_string(clean.seed) + ": error " +
              fixed(100.0 * clean.error_m, 2) + " cm, " + std::to_string(clean.messages.size()) +
              " warnings");
  for (const std::string& line : clean.messages) console.say("  " + line);
  std::cout.flush();
}

ordered_json clean_json(const CleanRun& clean) {
  return {{"seed", clean.seed},
          {"error_m", clean.error_m},
          {"keyframes", clean.keyframes},
          {"messages", clean.messages}};
}

void run_robustness(Console& console, const EvaluateCommand& command) {
  const std::vector<DriveFault> faults = chosen_faults(command.only);
  const int drives = command.repeats > 0 ? command.repeats : command.quick ? 1 : kDrives;
  RobustnessDrive place;
  if (!command.quick) place.size = "full";
  std::vector<FaultTally> tallies(faults.size());
  ordered_json clean = ordered_json::array();
  for (int i = 0; i < drives; ++i) {
    const RobustnessResult result =
        study_robustness(place, faults, command.seed + static_cast<std::uint64_t>(i),
                         command.threads, console.progress());
    say_clean(result.clean, console);
    clean.push_back(clean_json(result.clean));
    for (std::size_t f = 0; f < faults.size(); ++f) {
      tallies[f].fault = faults[f].name;
      tallies[f].runs.push_back(result.runs[f]);
    }
  }
  ordered_json list = ordered_json::array();
  for (const FaultTally& tally : tallies) {
    say_fault(tally, console);
    list.push_back(fault_json(tally));
  }
  const ordered_json json{{"experiment", "robustness"},
                          {"seed", command.seed},
                          {"place", place.scenario + ", " + place.size},
                          {"clean", clean},
                          {"faults", list}};
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment robustness_experiment() {
  return {"robustness",
          "what map makes of damaged recordings and wrong calibrations (--only: beginnings of "
          "names of faults)",
          run_robustness};
}

}  // namespace roadbook
