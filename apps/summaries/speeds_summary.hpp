#pragma once

#include "apps/console.hpp"
#include "workflows/make_speeds.hpp"

namespace roadbook {

/// Prints the result of `speeds`: unused detections, coverage, the slowest place of each lane; with
/// `--json` as one object.
void print_speeds(const Console& console, const SpeedsResult& result);

}  // namespace roadbook
