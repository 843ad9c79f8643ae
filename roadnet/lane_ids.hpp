#pragma once

#include "roadnet/network.hpp"

namespace roadbook {

/// Gives the parts of a network ids, and an order and direction that depend on positions alone.
///
/// Lanes run in the direction of most passes; if both directions have equally many, from the end
/// with the smaller x (then y). A lane or intersection at the position of one in `previous` keeps
/// its id, and a lane its direction. Other parts get ids derived from their position.
void assign_stable_ids(RoadNetwork& network, const RoadNetwork* previous);

}  // namespace roadbook
