#include <memory>
#include <nlohmann/json.hpp>

#include "apps/report/diagnosis_page.hpp"
#include "apps/summaries/diagnosis_summary.hpp"
#include "apps/verb.hpp"
#include "base/whole_file.hpp"
#include "workflows/diagnosis/correctable_model.hpp"
#include "workflows/settings/effect_model.hpp"

namespace roadbook {
namespace {

struct DiagnoseCommand {
  std::vector<std::filesystem::path> drives;
  std::filesystem::path map;
  std::filesystem::path output;
  std::filesystem::path write_model;
  std::filesystem::path model;
  std::vector<std::string> without;
  bool list_effects = false;
  bool keep = false;
  bool compare = false;
  bool ledger = false;
  int again = 0;
};

DiagnosisRequest diagnosis_request(const DiagnoseCommand& command) {
  if (command.drives.empty())
    throw InvalidOption("DRIVE", "nothing", "the folder of a drive or the YAML of a plain log");
  check_effects_left_out(command.without);
  const std::filesystem::path& drive = command.drives.front();
  DiagnosisRequest request{
      drive, command.map, {}, command.without, {command.drives.begin() + 1, command.drives.end()}};
  if (command.keep && !request.more.empty())
    throw InvalidOption("--keep", "several drives",
                        "one drive (a ledger keeps runs of single drives)");
  request.compare = command.compare;
  if (!command.model.empty()) request.known = read_effect_model(command.model);
  // A plain log has no views in a map. With --keep, the map only stores the ledger.
  if (command.keep && std::filesystem::is_regular_file(drive)) request.map.clear();
  return request;
}

void run_diagnose(const DiagnoseCommand& command, int threads, Console& console) {
  if (command.list_effects) return print_effects(console);
  if ((command.ledger || command.keep || command.again > 0) && command.map.empty())
    throw InvalidOption("--map", "nothing", "the map with the ledger");
  if (command.ledger) return print_ledger(command.map, console);
  if (command.again > 0)
    return print_repeated(repeat_ledger_run(command.map, command.again, threads, console),
                          command.again, command.map, console);
  const DiagnosisRequest request = diagnosis_request(command);
  const auto hold = command.keep ? hold_ledger(command.map) : nullptr;
  const DiagnosisRun made = run_diagnosis(request, threads, console);
  if (!command.write_model.empty())
    write_whole_file(command.write_model, effect_model_text(correctable_model(made.diagnosis)));
  if (!command.output.empty())
    write_whole_file(command.output, diagnosis_page(made.diagnosis, made.name, made.stated));
  nlohmann::ordered_json result = say_diagnosis(made, command.compare, console);
  if (command.keep) {
    const auto number = keep_in_ledger(command.map, request, made);
    console.say("kept as run " + std::to_string(number) + " of " + command.map.string());
    result["ledger_run"] = number;
  }
  console.result(result);
}

}  // namespace

Verb diagnose_verb() {
  auto command = std::make_shared<DiagnoseCommand>();
  return {"diagnose", "reports which effects of the sensor models a drive shows",
          [command](Options& options) {
            options.add(
                "DRIVE", &command->drives,
                "folder of a drive, or YAML of a plain log; several: drives of one vehicle");
            options.add("--map,-m", &command->map,
                        "map of the drive: its camera observations are used as well");
            options.add("--output,-o", &command->output, "HTML report to write");
            options.add("--model", &command->model, "YAML file of known effects");
            options.add("--write-model", &command->write_model,
                        "write the extended model, without effects of one place");
            options.add("--without", &command->without,
                        "effect to leave out of the catalogue; may be repeated");
            options.add("--compare", &command->compare, "simulate the drive again and compare it");
            options.add("--keep", &command->keep, "write the result to the map's ledger");
            options.add("--ledger", &command->ledger, "print the map's ledger; needs no drive");
            options.add("--again", &command->again, "repeat this run of the ledger; needs no drive")
                .range = {1, 1e6};
            options.add("--list-effects", &command->list_effects,
                        "print names, units and sizes; needs no drive");
          },
          [command](Console& console, const CommonOptions& common) {
            run_diagnose(*command, common.threads, console);
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
