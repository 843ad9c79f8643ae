#pragma once

#include <filesystem>

#include "apps/console.hpp"
#include "workflows/learn_friction.hpp"

namespace roadbook {

/// Prints the result of `friction`; with `--json` as one object. `drive` gives the names of its
/// tables.
void print_friction(const Console& console,
                    const FrictionResult& result,
                    const std::filesystem::path& drive);

}  // namespace roadbook
