#pragma once

#include "apps/console.hpp"
#include "workflows/find_roads.hpp"

namespace roadbook {

/// Prints the result of `roads`; with `--json` as one object. It marks paths that deviate from the
/// driven line by more than `max_deviation_m`.
void print_roads(const Console& console, const RoadsResult& result, double max_deviation_m);

}  // namespace roadbook
