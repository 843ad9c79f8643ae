#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/console.hpp"
#include "apps/options.hpp"
#include "sensors/vehicle.hpp"

namespace roadbook {

/// Declares `--vehicle FILE.yaml`.
void add_vehicle_option(Options& options, std::filesystem::path* file);

/// Returns the measures in `file`. Empty if no file is given. Throws BadInput.
[[nodiscard]] std::optional<VehicleMeasures> given_vehicle(const std::filesystem::path& file);

/// Prints one line: the source of the own vehicle's measures in the sessions.
void say_vehicle(const Console& console, const std::vector<VehicleSource>& sources);

/// Returns "file", "option", "measured" or "none", or a list of these if sessions differ.
[[nodiscard]] nlohmann::ordered_json vehicle_json(const std::vector<VehicleSource>& sources);

}  // namespace roadbook
