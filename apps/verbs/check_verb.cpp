#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/summary_json.hpp"
#include "apps/verb.hpp"
#include "base/format.hpp"
#include "drive/check.hpp"
#include "mapping/store/map_check.hpp"
#include "workflows/deep_map_check.hpp"

namespace roadbook {
namespace {

ExitStatus status_of(const std::vector<Problem>& problems) {
  const bool bad = std::any_of(problems.begin(), problems.end(), [](const Problem& problem) {
    return problem.severity == Severity::kError;
  });
  return bad ? ExitStatus::kBadInput : ExitStatus::kDone;
}

void say_verdict(const Console& console, const std::vector<Problem>& problems) {
  console.warn(problems);
  if (problems.empty()) console.say("no problem found");
}

ExitStatus check_recording(const std::filesystem::path& folder, Console& console) {
  const DriveReport report = check_drive(folder);
  nlohmann::ordered_json streams = nlohmann::ordered_json::array();
  for (const StreamSummary& stream : report.streams) {
    streams.push_back({{"name", stream.name},
                       {"rows", stream.rows},
                       {"rate", stream.rate_hz},
                       {"gaps", stream.gaps}});
    console.say(stream.name + ": " + std::to_string(stream.rows) + " rows, " +
                fixed(stream.rate_hz, 2) + " Hz, " + std::to_string(stream.gaps) +
                (stream.gaps == 1 ? " gap" : " gaps"));
  }
  say_verdict(console, report.problems);
  console.result({{"problems", to_json(report.problems)}, {"streams", streams}});
  return status_of(report.problems);
}

ExitStatus check_file(const std::filesystem::path& file, bool deep, int threads, Console& console) {
  const MapReport report = deep ? check_map_deep(file, threads, console) : check_map(file);
  for (const auto& [table, rows] : report.rows)
    console.say(table + ": " + std::to_string(rows) + " rows");
  say_verdict(console, report.problems);
  if (!report.digest.empty()) console.say("digest " + report.digest);
  console.result({{"problems", to_json(report.problems)},
                  {"streams", nlohmann::ordered_json::array()},
                  {"rows", report.rows},
                  {"digest", report.digest}});
  return status_of(report.problems);
}

ExitStatus check_nothing(const std::filesystem::path& path, Console& console) {
  const std::vector<Problem> problems{{Severity::kError, path.string(), 0, "",
                                       "no such file or folder",
                                       "the folder of a drive, or a map file"}};
  say_verdict(console, problems);
  console.result({{"problems", to_json(problems)}, {"streams", nlohmann::ordered_json::array()}});
  return ExitStatus::kBadInput;
}

}  // namespace

Verb check_verb() {
  auto path = std::make_shared<std::filesystem::path>();
  auto deep = std::make_shared<bool>(false);
  return {"check", "validates a drive or a map, in seconds",
          [=](Options& options) {
            options.add("PATH", path.get(), "folder of a drive, or map file").required = true;
            options.add("--deep", deep.get(),
                        "also whether poses, landmarks, wheels and covariances of a map agree");
          },
          [=](Console& console, const CommonOptions& common) {
            if (!std::filesystem::exists(*path)) return check_nothing(*path, console);
            if (!std::filesystem::is_directory(*path))
              return check_file(*path, *deep, common.threads, console);
            if (*deep) throw InvalidOption("--deep", path->string() + ", a drive", "a map file");
            return check_recording(*path, console);
          }};
}

}  // namespace roadbook
