#pragma once

#include <nlohmann/json.hpp>

#include "mapping/map.hpp"

namespace roadbook {

/// Converts a complete shape on the ground from an earlier state of the map to coordinates of the
/// current map. The shape moves together with the vehicle pose at which it was drawn, as labels do.
/// `body` has `pose` {session, t_ns, camera, x, y, heading}: the vehicle pose at that time in the
/// earlier map. Without `pose`, the shape is already in coordinates of the current map. The
/// conversion ignores tilt, because the ground is level within the few metres between shape and
/// vehicle. Throws RequestError 422 if the current map has no pose at that time.
[[nodiscard]] nlohmann::json on_map_of_today(const Map& map, nlohmann::json body);

}  // namespace roadbook
