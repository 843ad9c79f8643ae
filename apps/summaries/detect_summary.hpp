#pragma once

#include "apps/console.hpp"
#include "workflows/detect_people.hpp"

namespace roadbook {

/// With `--json` prints what `detect` did as one object; its lines come while it runs.
void print_detections(const Console& console, const DetectResult& result);

}  // namespace roadbook
