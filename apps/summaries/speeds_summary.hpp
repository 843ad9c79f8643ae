#pragma once

#include "apps/console.hpp"
#include "workflows/make_speeds.hpp"

namespace roadbook {

/// Prints what `speeds` did: detections left out, coverage, the slowest place of each lane; with
/// `--json` one object.
void print_speeds(const Console& console, const SpeedsResult& result);

}  // namespace roadbook
