#pragma once

#include "apps/console.hpp"
#include "workflows/find_roads.hpp"

namespace roadbook {

/// Prints what `roads` did; with `--json` one object. `max_deviation_m`: of a path from the driven
/// line, beyond which it is marked.
void print_roads(const Console& console, const RoadsResult& result, double max_deviation_m);

}  // namespace roadbook
