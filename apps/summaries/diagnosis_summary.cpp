#include "apps/summaries/diagnosis_summary.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "sensors/effects.hpp"
#include "workflows/diagnosis/diagnosis_json.hpp"
#include "workflows/diagnosis/diagnosis_ledger.hpp"

namespace roadbook {

using nlohmann::ordered_json;

void print_effects(const Console& console) {
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

ordered_json say_diagnosis(const DiagnosisRun& run, bool compare, const Console& console) {
  const Diagnosis& d = run.diagnosis;
  for (const auto& lines : {advice_lines(d, run.stated), to_lines(d), comparison_lines(d)})
    for (const std::string& line : lines) console.say(line);
  ordered_json result = to_json(d);
  if (compare) result["simulation"] = comparison_json(d);
  result["advice"] = advice_json(d, run.stated);
  return result;
}

void print_ledger(const std::filesystem::path& map, const Console& console) {
  ordered_json runs = ordered_json::array();
  for (const LedgerRun& run : read_ledger(map)) {
    console.say("run " + std::to_string(runs.size() + 1) + ", " + run.drive);
    for (const std::string& line : ledger_lines(run)) console.say("  " + line);
    runs.push_back({{"run", runs.size() + 1},
                    {"drive", run.drive},
                    {"options", run.options},
                    {"result", run.result}});
  }
  if (runs.empty()) console.say("no run of diagnose is stored in " + map.string());
  console.result({{"runs", runs}});
}

void print_repeated(const RepeatedRun& run,
                    int number,
                    const std::filesystem::path& map,
                    const Console& console) {
  for (const std::string& line : to_lines(run.diagnosis)) console.say(line);
  console.result({{"run", number}, {"same", run.is_same}, {"result", to_json(run.diagnosis)}});
  if (!run.is_same)
    throw Refused("error: " + map.string() + ": run " + std::to_string(number) + ": " +
                  run.difference);
  console.say("run " + std::to_string(number) + " gives the same result again");
}

}  // namespace roadbook
