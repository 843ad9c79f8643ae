#pragma once

#include <nlohmann/json.hpp>

#include "mapping/map.hpp"

namespace roadbook {

/// A shape on the ground, all of it, that was drawn on an earlier state of the map, in coordinates
/// of today's: it goes along with the vehicle beside which it was drawn, as labels do. `body` with
/// `pose` {session, t_ns, camera, x, y, heading}: where the earlier map had that vehicle at that
/// moment; without, it is of today. Tilt is left out: the ground is level within the metres between
/// them. Throws RequestError 422 where the map of today has no pose of that moment.
[[nodiscard]] nlohmann::json on_map_of_today(const Map& map, nlohmann::json body);

}  // namespace roadbook
