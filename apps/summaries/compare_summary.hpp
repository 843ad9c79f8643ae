#pragma once

#include "apps/console.hpp"
#include "workflows/compare/compare_files.hpp"

namespace roadbook {

/// Prints what `compare` found: lines for a reader, or with `--json` one object. `with_value`:
/// the value of sessions was requested. `page`: the HTML file that was written, or empty.
void print_comparison(const Console& console,
                      const FileComparison& comparison,
                      bool with_value,
                      const std::filesystem::path& page);

}  // namespace roadbook
