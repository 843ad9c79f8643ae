#pragma once

#include "apps/console.hpp"
#include "workflows/detect_people.hpp"

namespace roadbook {

/// With `--json`, prints the result of `detect` as one object. The lines of text are printed during
/// the run.
void print_detections(const Console& console, const DetectResult& result);

}  // namespace roadbook
