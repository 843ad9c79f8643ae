#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "apps/evaluation/robustness/alike_places.hpp"
#include "apps/evaluation/robustness/removed_loops.hpp"
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

/// A place with parts that look the same, and the name of its study.
struct AlikeStudy {
  std::string name;
  std::string scenario;
};

/// What to study.
struct Chosen {
  std::vector<DriveFault> faults;
  std::vector<AlikeStudy> alike;
};

Chosen chosen_studies(const std::string& only) {
  Chosen all{wheel_faults(), {{"alike: two storeys", "storeys"}, {"alike: equal bays", "bays"}}};
  for (DriveFault& fault : camera_faults()) all.faults.push_back(std::move(fault));
  if (only.empty()) return all;
  const auto is_chosen = [&](const auto& study) {
    const auto beginnings = split(only);
    return std::any_of(beginnings.begin(), beginnings.end(), [&](const std::string_view beginning) {
      return study.name.starts_with(beginning);
    });
  };
  Chosen chosen;
  std::copy_if(all.faults.begin(), all.faults.end(), std::back_inserter(chosen.faults), is_chosen);
  std::copy_if(all.alike.begin(), all.alike.end(), std::back_inserter(chosen.alike), is_chosen);
  if (!chosen.faults.empty() || !chosen.alike.empty()) return chosen;
  std::string names;
  for (const DriveFault& fault : all.faults) names += (names.empty() ? "" : "; ") + fault.name;
  for (const AlikeStudy& study : all.alike) names += "; " + study.name;
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

std::string count_text(const LoopCount& count) {
  return std::to_string(count.all) + " (" + std::to_string(count.wrong) + " false)";
}

ordered_json count_json(const LoopCount& count) {
  return {{"all", count.all}, {"false", count.wrong}};
}

ordered_json judged_json(const AlikeResult& result) {
  return {{"candidates", result.candidates},         {"forced", result.forced},
          {"verified", count_json(result.verified)}, {"accepted", count_json(result.accepted)},
          {"kept", count_json(result.kept)},         {"largest_bend_m", result.largest_bend_m}};
}

std::string judged_text(const AlikeResult& result) {
  return std::to_string(result.candidates) + " candidates, verified " +
         count_text(result.verified) + ", accepted " + count_text(result.accepted) + ", kept " +
         count_text(result.kept) + "; poses bent by " + fixed(result.largest_bend_m, 3) + " m";
}

/// Maps one drive through such a place. Then offers the map pairs of different places that look the
/// same, and removes single loops.
ordered_json run_alike(const AlikeStudy& study,
                       std::uint64_t seed,
                       const EvaluateCommand& command,
                       Console& console) {
  constexpr int kForced = 1000;
  const std::size_t removals = command.quick ? 3 : 10;
  MapOptions options;
  options.num_threads = command.threads;
  AlikeDrive drive =
      drive_alike_place({.scenario = study.scenario, .size = command.quick ? "small" : "full"},
                        seed, command.threads, console.progress());
  const AlikeResult own = judge_loops(drive, 0, options, console.progress());
  const AlikeResult forced = judge_loops(drive, kForced, options, console.progress());
  const LoopedMap map = map_with_loops(std::move(drive.input), options, console.progress());
  RemovedLoop graph, bundle;
  const auto keep_largest = [](const RemovedLoop& one, RemovedLoop& largest) {
    largest.position = std::max(largest.position, one.position);
    largest.heading = std::max(largest.heading, one.heading);
  };
  for (const std::size_t loop : drawn_loops(map, removals, seed)) {
    keep_largest(remove_loop(map, loop, false, options), graph);
    keep_largest(remove_loop(map, loop, true, options), bundle);
  }
  const std::string name = study.name + ", seed " + std::to_string(seed) + ": ";
  console.say(name + judged_text(own));
  console.say(name + std::to_string(forced.forced) +
              " alike pairs offered: " + judged_text(forced));
  console.say(name + "without one loop, poses move by at most " + fixed(graph.position, 2) +
              " sigma in the pose graph (heading " + fixed(graph.heading, 2) + ") and " +
              fixed(bundle.position, 2) + " in the map (heading " + fixed(bundle.heading, 2) + ")");
  std::cout.flush();
  return {{"place", study.name},
          {"seed", seed},
          {"own", judged_json(own)},
          {"offered", judged_json(forced)},
          {"without_one_loop",
           {{"graph_position_sigma", graph.position},
            {"graph_heading_sigma", graph.heading},
            {"map_position_sigma", bundle.position},
            {"map_heading_sigma", bundle.heading}}}};
}

void run_robustness(Console& console, const EvaluateCommand& command) {
  const Chosen chosen = chosen_studies(command.only);
  const std::vector<DriveFault>& faults = chosen.faults;
  const int drives = command.repeats > 0 ? command.repeats : command.quick ? 1 : kDrives;
  RobustnessDrive place;
  if (!command.quick) place.size = "full";
  std::vector<FaultTally> tallies(faults.size());
  ordered_json clean = ordered_json::array();
  for (int i = 0; i < drives && !faults.empty(); ++i) {
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
  ordered_json alike = ordered_json::array();
  for (const AlikeStudy& study : chosen.alike)
    for (int i = 0; i < drives; ++i)
      alike.push_back(
          run_alike(study, command.seed + static_cast<std::uint64_t>(i), command, console));
  const ordered_json json{{"experiment", "robustness"},
                          {"seed", command.seed},
                          {"place", place.scenario + ", " + place.size},
                          {"clean", clean},
                          {"faults", list},
                          {"alike_places", alike}};
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment robustness_experiment() {
  return {"robustness",
          "what map makes of damaged recordings, wrong calibrations and places that look the same "
          "(--only: beginnings of names of faults)",
          run_robustness};
}

}  // namespace roadbook
