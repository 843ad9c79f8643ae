#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "apps/evaluation/covariance/covariance_study.hpp"
#include "base/error.hpp"
#include "base/format.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr int kDrivesOfKind = 20;
constexpr int kQuickDrives = 4;

std::vector<CoverageKind> chosen_kinds(const EvaluateCommand& command) {
  const std::vector<CoverageKind> all = coverage_kinds(command.quick);
  if (command.only.empty()) return all;
  std::vector<CoverageKind> chosen;
  std::string names;
  for (const CoverageKind& kind : all) {
    names += (names.empty() ? "" : "; ") + kind.name;
    for (const std::string_view beginning : split(command.only))
      if (kind.name.starts_with(trim(beginning))) {
        chosen.push_back(kind);
        break;
      }
  }
  if (chosen.empty())
    throw InvalidOption("--only", "'" + command.only + "'", "what names begin with: " + names);
  return chosen;
}

std::string words_of(const RegionShare& region) {
  return fixed(100.0 * region.share(), 1) + " % (" + fixed(region.mean_square(), 2) + ")";
}

ordered_json json_of(const RegionShare& region) {
  if (region.count == 0) return nullptr;
  return {{"count", region.count},
          {"inside_share", region.share()},
          {"mean_square", region.mean_square()}};
}

ordered_json json_of(const CoverageKind& kind, const CoverageTally& tally) {
  const Coverage& c = tally.coverage;
  return {{"kind", kind.name},
          {"drives", tally.drives},
          {"refused", tally.refused},
          {"unknown", c.unknown},
          {"position", json_of(c.position)},
          {"position_3d", json_of(c.position_3d)},
          {"heading", json_of(c.heading)},
          {"six", json_of(c.six)},
          {"landmarks", json_of(c.landmarks)}};
}

void say_kind(const CoverageKind& kind, const CoverageTally& tally, Console& console) {
  const Coverage& c = tally.coverage;
  console.say(kind.name + ": " + std::to_string(tally.drives) + " drives, " +
              std::to_string(tally.refused) + " refused; inside (mean square): position " +
              words_of(c.position) + ", with height " + words_of(c.position_3d) + ", heading " +
              words_of(c.heading) + ", all six " + words_of(c.six) + ", landmarks " +
              words_of(c.landmarks) + "; unknown " + std::to_string(c.unknown));
  std::cout.flush();
}

void run_covariance(Console& console, const EvaluateCommand& command) {
  const int drives =
      command.repeats > 0 ? command.repeats : (command.quick ? kQuickDrives : kDrivesOfKind);
  ordered_json list = ordered_json::array();
  for (const CoverageKind& kind : chosen_kinds(command)) {
    CoverageTally tally;
    for (int i = 0; i < drives; ++i) {
      tally.add(coverage_of_drive(kind, command.seed + static_cast<std::uint64_t>(i),
                                  command.threads, console.progress()));
      report(console.progress(), "covariance", static_cast<std::size_t>(i) + 1,
             static_cast<std::size_t>(drives));
    }
    say_kind(kind, tally, console);
    list.push_back(json_of(kind, tally));
  }
  const ordered_json json{{"experiment", "covariance"}, {"seed", command.seed}, {"kinds", list}};
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment covariance_experiment() {
  return {"covariance",
          "share of true errors inside the 95 % regions that maps state (--only: beginnings of "
          "names of kinds of drives, several with commas)",
          run_covariance};
}

}  // namespace roadbook
