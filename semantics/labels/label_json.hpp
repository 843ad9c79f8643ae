#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "semantics/labels/labels.hpp"

namespace roadbook {

// Labels as JSON objects in the map's list of events (over the wire they are others:
// apps/label_server/label_wire.hpp). Lengths in metres, stamps as whole numbers of nanoseconds.

[[nodiscard]] nlohmann::ordered_json label_to_json(const Label& label);

/// Every field but `id`, `version`, `state`, `who`, `t_ns`, `sightings` and `seen` must be there,
/// no others may; throws BadInput naming `source` and the field.
[[nodiscard]] Label label_from_json(const nlohmann::ordered_json& json, const std::string& source);

}  // namespace roadbook
