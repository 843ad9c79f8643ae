#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/report/diagnosis_page.hpp"
#include "apps/verb.hpp"
#include "apps/verbs/diagnosis_json.hpp"
#include "apps/verbs/diagnosis_run.hpp"
#include "base/whole_file.hpp"
#include "workflows/diagnosis_ledger.hpp"
#include "workflows/settings/effect_model.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

struct DiagnoseCommand {
  std::vector<std::filesystem::path> drives;
  std::filesystem::path map;
  std::filesystem::path output;
  std::filesystem::path write_model;
  std::filesystem::path model;
  std::vector<std::string> without;
  bool list_effects = false;
  bool keep = false;
  bool ledger = false;
  int again = 0;
};

void list_effects(Console& console) {
  ordered_json effects = ordered_json::array();
  for (const EffectInfo& e : all_effects()) {
    char sizes[120];
    std::snprintf(sizes, sizeof sizes, "]: plausible %g, bounds %g to %g, ", e.plausible, e.lowest,
                  e.highest);
    console.say(std::string(e.name) + " [" + std::string(e.unit) + sizes +
                (e.covariate.empty() ? "constant" : "grows with " + std::string(e.covariate)) +
                ": " + std::string(e.description));
    effects.push_back({{"effect", e.name},
                       {"unit", e.unit},
                       {"plausible", e.plausible},
                       {"lowest", e.lowest},
                       {"highest", e.highest},
                       {"covariate", e.covariate},
                       {"description", e.description}});
  }
  console.result({{"effects", effects}});
}

void show_ledger(const std::filesystem::path& map, Console& console) {
  ordered_json runs = ordered_json::array();
  for (const LedgerRun& run : read_ledger(map)) {
    console.say("run " + std::to_string(runs.size() + 1) + ", " + run.drive);
    for (const std::string& line : ledger_lines(run)) console.say("  " + line);
    runs.push_back({{"run", runs.size() + 1},
                    {"drive", run.drive},
                    {"options", run.options},
                    {"result", run.result}});
  }
  if (runs.empty()) console.say("no run of diagnose is kept in " + map.string());
  console.result({{"runs", runs}});
}

LedgerRun ledger_run(const DiagnosisRequest& request,
                     const DiagnosisRun& run,
                     const std::filesystem::path& map) {
  std::error_code ignored;
  const auto folder = std::filesystem::absolute(map).parent_path();
  const auto relative = std::filesystem::relative(request.drive, folder, ignored);
  return {relative.empty() ? request.drive.string() : relative.string(),
          run.digest,
          {{"known", request.known},
           {"without", request.without},
           {"through_map", !request.map.empty()}},
          to_json(run.diagnosis),
          request.map.empty() ? "" : viewed_content(request.map)};
}

// Why a run that is made again has other numbers.
std::string other_numbers(const LedgerRun& kept, const std::filesystem::path& map) {
  if (kept.map_digest.empty()) return "got other numbers, want those of the ledger";
  const std::string now = viewed_content(map);
  if (now == kept.map_digest)
    return "got other numbers from the same map, want those of the ledger";
  return "got other numbers: poses and landmarks of the map are others now (digest " +
         now.substr(0, 12) + "), want those of the run (" + kept.map_digest.substr(0, 12) + ")";
}

// A run of the ledger made again: the same numbers, or Refused.
ExitStatus run_again(const DiagnoseCommand& command, int threads, Console& console) {
  const std::vector<LedgerRun> runs = read_ledger(command.map);
  if (command.again > static_cast<int>(runs.size()))
    throw InvalidOption(
        "--again", std::to_string(command.again),
        "one of the " + std::to_string(runs.size()) + " runs kept in " + command.map.string());
  const LedgerRun& kept = runs[static_cast<std::size_t>(command.again - 1)];
  DiagnosisRequest request;
  request.drive = std::filesystem::absolute(command.map).parent_path() / kept.drive;
  if (kept.options.at("through_map").get<bool>()) request.map = command.map;
  request.known = kept.options.at("known").get<EffectSizes>();
  request.without = kept.options.at("without").get<std::vector<std::string>>();
  const DiagnosisRun run = run_diagnosis(request, threads, console);
  if (run.digest != kept.drive_digest)
    throw BadInput({Severity::kError, request.drive.string(), 0, "digest", run.digest,
                    kept.drive_digest + ": the drive has changed since"});
  const ordered_json result = to_json(run.diagnosis);
  const bool same = result == kept.result;
  for (const std::string& line : to_lines(run.diagnosis)) console.say(line);
  console.result({{"run", command.again}, {"same", same}, {"result", result}});
  if (!same)
    throw Refused("error: " + command.map.string() + ": run " + std::to_string(command.again) +
                  ": " + other_numbers(kept, command.map));
  console.say("run " + std::to_string(command.again) + " gives the same numbers again");
  return ExitStatus::kDone;
}

// A misspelt name would leave nothing out, and nobody would notice.
void check_without(const std::vector<std::string>& names) {
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

ExitStatus run_diagnose(const DiagnoseCommand& command, int threads, Console& console) {
  if (command.list_effects) {
    list_effects(console);
    return ExitStatus::kDone;
  }
  if ((command.ledger || command.keep || command.again > 0) && command.map.empty())
    throw InvalidOption("--map", "nothing", "the map whose ledger is meant");
  if (command.ledger) {
    show_ledger(command.map, console);
    return ExitStatus::kDone;
  }
  if (command.again > 0) return run_again(command, threads, console);
  if (command.drives.empty())
    throw InvalidOption("DRIVE", "nothing", "the folder of a drive or the YAML of a plain log");
  check_without(command.without);
  const std::filesystem::path& drive = command.drives.front();
  DiagnosisRequest request{
      drive, command.map, {}, command.without, {command.drives.begin() + 1, command.drives.end()}};
  if (command.keep && !request.more.empty())
    throw InvalidOption("--keep", "several drives",
                        "one: a map's ledger keeps runs of single ones");
  if (!command.model.empty()) request.known = read_effect_model(command.model);
  // A plain log has no views in a map; with --keep the map is there for its ledger.
  if (command.keep && std::filesystem::is_regular_file(drive)) request.map.clear();
  const DiagnosisRun made = run_diagnosis(request, threads, console);
  if (!command.write_model.empty())
    write_whole_file(command.write_model, effect_model_text(made.diagnosis.extended));
  if (!command.output.empty())
    write_whole_file(command.output, diagnosis_page(made.diagnosis, made.name));
  for (const std::string& line : to_lines(made.diagnosis)) console.say(line);
  ordered_json result = to_json(made.diagnosis);
  if (command.keep) {
    const auto number = add_to_ledger(command.map, ledger_run(request, made, command.map));
    console.say("kept as run " + std::to_string(number) + " of " + command.map.string());
    result["ledger_run"] = number;
  }
  console.result(result);
  return ExitStatus::kDone;
}

}  // namespace

Verb diagnose_verb() {
  auto command = std::make_shared<DiagnoseCommand>();
  return {
      "diagnose", "says what the simulation gets wrong in a recorded drive",
      [command](Options& options) {
        options.add(
            "DRIVE", &command->drives,
            "folder of the drive, or YAML of a plain log; several folders: drives of one vehicle");
        options.add("--map,-m", &command->map, "map of the drive: its views are looked at as well");
        options.add("--output,-o", &command->output, "HTML report to write");
        options.add("--model", &command->model, "YAML file of effects that are known already");
        options.add("--write-model", &command->write_model,
                    "keeps the extended model, but not what acts in one place");
        options.add("--without", &command->without, "effect left out of the catalogue");
        options.add("--keep", &command->keep, "writes the findings to the map's ledger");
        options.add("--ledger", &command->ledger, "shows the map's ledger; no drive");
        options.add("--again", &command->again, "makes this run of the ledger again; no drive")
            .range = {1, 1e6};
        options.add("--list-effects", &command->list_effects, "names, units and sizes; no drive");
      },
      [command](Console& console, const CommonOptions& common) {
        return run_diagnose(*command, common.threads, console);
      }};
}

}  // namespace roadbook
