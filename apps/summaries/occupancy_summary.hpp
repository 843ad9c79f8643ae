#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "apps/console.hpp"
#include "workflows/occupancy/make_occupancy.hpp"

namespace roadbook {

/// The value of `--temper`: empty for "auto". Throws InvalidOption.
[[nodiscard]] std::optional<double> temper_option(const std::string& text);

/// Prints the result of `occupancy`; with `--json` as one object.
void print_occupancy(const Console& console, const OccupancyResult& result);

/// Figures against the truth, and of the beam model.
[[nodiscard]] nlohmann::ordered_json to_json(const OccupancyTruth& truth);
[[nodiscard]] nlohmann::ordered_json to_json(const RangeMixture& mixture);

}  // namespace roadbook
