#pragma once

#include "apps/console.hpp"
#include "workflows/compare/compare_files.hpp"

namespace roadbook {

/// Prints what `compare` found: lines for a reader, or with `--json` one object.
void print_comparison(const Console& console, const FileComparison& comparison);

}  // namespace roadbook
