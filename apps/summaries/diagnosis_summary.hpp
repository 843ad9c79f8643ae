#pragma once

#include <filesystem>

#include "apps/console.hpp"
#include "workflows/diagnosis/ledger_runs.hpp"

namespace roadbook {

/// Prints the catalogue of effects: names, units, sizes, covariates, descriptions.
void print_effects(const Console& console);

/// Prints all runs in the ledger of `map`.
void print_ledger(const std::filesystem::path& map, const Console& console);

/// Prints a repeated run of the ledger. Throws Refused if its numbers differ.
void print_repeated(const RepeatedRun& run,
                    int number,
                    const std::filesystem::path& map,
                    const Console& console);

}  // namespace roadbook
