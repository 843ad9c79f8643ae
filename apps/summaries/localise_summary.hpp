#pragma once

#include <optional>
#include <string>

#include "apps/console.hpp"
#include "workflows/localisation/localise_in_map.hpp"

namespace roadbook {

/// Reads "X,Y,HEADING" [m, m, rad]; empty for an empty text. Throws InvalidOption.
[[nodiscard]] std::optional<StartPose> start_pose(const std::string& text);

/// Prints the result of `localise`; with `--json` as one object.
void print_localisation(const Console& console, const LocaliseResult& result);

}  // namespace roadbook
