#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/console.hpp"
#include "workflows/localisation/localise_in_map.hpp"

namespace roadbook {

/// Reads "X,Y,HEADING" [m, m, rad]; empty for an empty text. Throws InvalidOption.
[[nodiscard]] std::optional<StartPose> start_pose(const std::string& text);

/// The figures as lines for a reader, and as an object.
[[nodiscard]] std::vector<std::string> localisation_lines(const LocalisationFigures& figures);
[[nodiscard]] nlohmann::ordered_json to_json(const LocalisationFigures& figures);

/// Prints the result of `localise`; with `--json` as one object.
void print_localisation(const Console& console, const LocaliseResult& result);

}  // namespace roadbook
