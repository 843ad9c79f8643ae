#pragma once

#include <filesystem>

#include "apps/console.hpp"
#include "workflows/overhead_of_map.hpp"

namespace roadbook {

/// Prints the result of `overhead`; with `--json` as one object.
void print_overhead(const Console& console,
                    const OverheadResult& result,
                    const std::filesystem::path& map);

}  // namespace roadbook
