#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "semantics/labels/labels.hpp"

namespace roadbook {

// Labels as JSON objects of the map's event log. (The HTTP interface uses another form:
// apps/label_server/label_wire.hpp.) Lengths in metres, stamps as integers in nanoseconds.

[[nodiscard]] nlohmann::ordered_json label_to_json(const Label& label);

/// All fields are required except `id`, `version`, `state`, `who`, `t_ns`, `sightings` and `seen`;
/// other fields are refused. Throws BadInput naming `source` and the field.
[[nodiscard]] Label label_from_json(const nlohmann::ordered_json& json, const std::string& source);

}  // namespace roadbook
