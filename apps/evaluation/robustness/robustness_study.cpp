#include "apps/evaluation/robustness/robustness_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "base/error.hpp"
#include "base/messages.hpp"
#include "base/temporary_folder.hpp"
#include "sim/simulate.hpp"
#include "workflows/map_drives.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

constexpr double kRightRatio = 1.5;
constexpr double kMappedShare = 0.8;

/// A map, or the error that prevented it.
struct Mapped {
  std::optional<MapSummary> summary;
  std::vector<std::string> messages;
};

// Warnings name files by their paths; the study compares those of two folders.
std::string without_folder(std::string line, const fs::path& folder) {
  const std::string prefix = folder.string() + "/";
  for (std::size_t at = line.find(prefix); at != std::string::npos; at = line.find(prefix))
    line.erase(at, prefix.size());
  return line;
}

Mapped map_drive(const fs::path& drive, const fs::path& map, std::uint64_t seed, int num_threads) {
  MapRequest request;
  request.drives = {drive};
  request.map = map;
  request.options.seed = seed;
  request.options.num_threads = request.options.tracking.num_threads = num_threads;
  Mapped mapped;
  try {
    NoMessages messages;
    mapped.summary = map_drives(request, messages).summary;
    for (const Problem& warning : mapped.summary->warnings)
      mapped.messages.push_back(without_folder(to_line(warning), drive));
  } catch (const Error& error) {
    if (error.status() != ExitStatus::kBadInput && error.status() != ExitStatus::kRefused) throw;
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);)
      mapped.messages.push_back(without_folder(line, drive));
  }
  return mapped;
}

// A copy of the drive whose files are the same files. What damages it replaces files.
void copy_drive(const fs::path& from, const fs::path& to) {
  fs::copy(from, to, fs::copy_options::recursive | fs::copy_options::create_hard_links);
}

bool holds_any(const std::string& line, const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return line.find(word) != std::string::npos; });
}

RobustnessOutcome outcome_of(const Mapped& mapped, const RobustnessRun& run) {
  if (!mapped.summary)
    return run.is_named ? RobustnessOutcome::kRefused : RobustnessOutcome::kRefusedElse;
  if (run.error_ratio <= kRightRatio && run.mapped_share >= kMappedShare)
    return RobustnessOutcome::kRight;
  return run.is_named ? RobustnessOutcome::kWrongSaid : RobustnessOutcome::kWrongSilent;
}

RobustnessRun run_fault(const fs::path& folder,
                        const DriveFault& fault,
                        const CleanRun& clean,
                        int num_threads) {
  const fs::path drive = folder / "damaged";
  copy_drive(folder / "clean", drive);
  Random random(clean.seed, fault.name);
  const PlantedFault planted = fault.plant(drive, random);
  const Mapped mapped = map_drive(drive, folder / "damaged.gpkg", clean.seed, num_threads);
  RobustnessRun run;
  run.fault = fault.name;
  run.seed = clean.seed;
  for (const std::string& line : mapped.messages)
    if (std::find(clean.messages.begin(), clean.messages.end(), line) == clean.messages.end())
      run.messages.push_back(line);
  for (const std::string& line : run.messages) {
    if (!holds_any(line, planted.sensors)) continue;
    run.is_named = true;
    if (planted.causes.empty() || holds_any(line, planted.causes)) run.names_cause = true;
  }
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  run.error_ratio =
      mapped.summary ? mapped.summary->ate_median_m.value_or(kUnknown) / clean.error_m : kUnknown;
  if (mapped.summary)
    run.mapped_share = static_cast<double>(mapped.summary->keyframes) /
                       static_cast<double>(std::max<std::size_t>(clean.keyframes, 1));
  run.outcome = outcome_of(mapped, run);
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().starts_with("damaged")) fs::remove_all(entry.path());
  return run;
}

}  // namespace

RobustnessResult study_robustness(const RobustnessDrive& place,
                                  const std::vector<DriveFault>& faults,
                                  std::uint64_t seed,
                                  int num_threads,
                                  const Progress& progress) {
  const TemporaryFolder folder;
  Scenario scenario =
      load_scenario(place.scenario, {.size = place.size, .image_scale = place.image_scale});
  scenario.seed += 1000 * seed;
  SimulateOptions options;
  options.seed = seed;
  options.max_duration_s = place.seconds;
  options.num_threads = num_threads;
  simulate(scenario, folder.path() / "clean", options, progress);
  const Mapped mapped =
      map_drive(folder.path() / "clean", folder.path() / "clean.gpkg", seed, num_threads);
  if (!mapped.summary) throw Refused(mapped.messages.front());
  RobustnessResult result;
  result.clean = {seed, mapped.summary->ate_median_m.value(), mapped.summary->keyframes,
                  mapped.messages};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    result.runs.push_back(run_fault(folder.path(), faults[i], result.clean, num_threads));
    report(progress, "robustness", i + 1, faults.size());
  }
  return result;
}

std::string name_of(RobustnessOutcome outcome) {
  switch (outcome) {
    case RobustnessOutcome::kRight:
      return "right";
    case RobustnessOutcome::kRefused:
      return "refused";
    case RobustnessOutcome::kRefusedElse:
      return "refused, sensor not named";
    case RobustnessOutcome::kWrongSaid:
      return "wrong, said";
    case RobustnessOutcome::kWrongSilent:
      return "wrong, silent";
  }
  return "";
}

}  // namespace roadbook
