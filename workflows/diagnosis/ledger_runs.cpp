#include "workflows/diagnosis/ledger_runs.hpp"

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "mapping/pipeline/map_paths.hpp"
#include "mapping/store/map_file_disk.hpp"
#include "mapping/store/map_file_open.hpp"
#include "workflows/diagnosis/diagnosis_json.hpp"
#include "workflows/diagnosis/diagnosis_ledger.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

LedgerRun ledger_run(const DiagnosisRequest& request,
                     const DiagnosisRun& run,
                     const std::filesystem::path& map) {
  return {path_from_map(request.drive, map),
          run.digest,
          {{"known", request.known},
           {"without", request.without},
           {"through_map", !request.map.empty()}},
          to_json(run.diagnosis),
          request.map.empty() ? "" : viewed_content(request.map)};
}

// Returns the reason why a repeated run has other numbers.
std::string difference_of(const LedgerRun& kept, const std::filesystem::path& map) {
  if (kept.map_digest.empty()) return "got other results, want those of the ledger";
  const std::string now = viewed_content(map);
  if (now == kept.map_digest)
    return "got other results from the same map, want those of the ledger";
  return "got other results, because poses or landmarks of the map have changed (digest " +
         now.substr(0, 12) + "), want those of the run (" + kept.map_digest.substr(0, 12) + ")";
}

}  // namespace

std::unique_ptr<MapHold> hold_ledger(const std::filesystem::path& map) {
  return std::make_unique<MapHold>(existing_map_file(map));
}

std::int64_t keep_in_ledger(const std::filesystem::path& map,
                            const DiagnosisRequest& request,
                            const DiagnosisRun& run) {
  return add_to_ledger(map, ledger_run(request, run, map));
}

RepeatedRun repeat_ledger_run(const std::filesystem::path& map,
                              int number,
                              int num_threads,
                              Messages& messages) {
  const std::vector<LedgerRun> runs = read_ledger(map);
  if (number > static_cast<int>(runs.size()))
    throw InvalidOption(
        "--again", std::to_string(number),
        "one of the " + std::to_string(runs.size()) + " runs kept in " + map.string());
  const LedgerRun& kept = runs[static_cast<std::size_t>(number - 1)];
  DiagnosisRequest request;
  request.drive = std::filesystem::absolute(linked_file(map)).parent_path() / kept.drive;
  if (kept.options.at("through_map").get<bool>()) request.map = map;
  request.known = kept.options.at("known").get<EffectSizes>();
  request.without = kept.options.at("without").get<std::vector<std::string>>();
  DiagnosisRun run = run_diagnosis(request, num_threads, messages);
  if (run.digest != kept.drive_digest)
    throw BadInput({Severity::kError, request.drive.string(), 0, "digest", run.digest,
                    kept.drive_digest + ": the drive has changed since"});
  RepeatedRun repeated;
  repeated.is_same = to_json(run.diagnosis) == kept.result;
  if (!repeated.is_same) repeated.difference = difference_of(kept, map);
  repeated.diagnosis = std::move(run.diagnosis);
  return repeated;
}

void check_effects_left_out(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (name.starts_with("STREAM."))
      throw InvalidOption("--without", name, "the noise of one stream: wheels0" + name.substr(6));
    try {
      check_effects({{name, 0.0}});
    } catch (const BadInput& bad) {
      const Problem& unknown = bad.problems().front();
      throw InvalidOption("--without", unknown.got, unknown.want);
    }
  }
}

}  // namespace roadbook
