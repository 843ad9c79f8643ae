#pragma once

#include "roadnet/network.hpp"

namespace roadbook {

/// Brings a network into an order and direction that depend on places alone, and names its parts.
///
/// Lanes run the way most passes went; where that is undecided, from the end with the smaller x
/// (then y). A lane or intersection that lies where one of `previous` lies keeps its id and, a
/// lane, its direction; the others get ids derived from their place.
void name_parts(RoadNetwork& network, const RoadNetwork* previous);

}  // namespace roadbook
