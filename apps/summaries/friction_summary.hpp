#pragma once

#include <filesystem>

#include "apps/console.hpp"
#include "workflows/learn_friction.hpp"

namespace roadbook {

/// Prints what `friction` did; with `--json` one object. `drive`: for the names of its tables.
void print_friction(const Console& console,
                    const FrictionResult& result,
                    const std::filesystem::path& drive);

}  // namespace roadbook
