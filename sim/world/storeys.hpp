#pragma once

#include "sim/world/world_content.hpp"

namespace roadbook {

// The ceilings of a place, and its upper storeys with the ramps between them.

/// Adds the ceilings of all storeys and their beams to the mesh. Every ceiling but the highest is
/// open over the ramps. Does nothing without a ceiling.
void add_ceilings(World& world);

/// Adds the floors of the upper storeys, the ramps, and copies of everything but ground and ceiling
/// that the mesh holds, one a storey. Does nothing without storeys.
void add_upper_storeys(World& world);

}  // namespace roadbook
