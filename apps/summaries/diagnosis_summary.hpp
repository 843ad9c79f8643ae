#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "apps/console.hpp"
#include "workflows/diagnosis/diagnosis_run.hpp"
#include "workflows/diagnosis/ledger_runs.hpp"

namespace roadbook {

/// Prints the catalogue of effects: names, units, sizes, covariates, descriptions.
void print_effects(const Console& console);

/// Prints a run: the advice, the findings, the comparison with the simulation. Returns its JSON;
/// `compare`: with the comparison.
[[nodiscard]] nlohmann::ordered_json say_diagnosis(const DiagnosisRun& run,
                                                   bool compare,
                                                   const Console& console);

/// Prints all runs in the ledger of `map`.
void print_ledger(const std::filesystem::path& map, const Console& console);

/// Prints a repeated run of the ledger. Throws Refused if its numbers differ.
void print_repeated(const RepeatedRun& run,
                    int number,
                    const std::filesystem::path& map,
                    const Console& console);

}  // namespace roadbook
