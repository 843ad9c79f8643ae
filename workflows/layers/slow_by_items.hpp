#pragma once

#include <optional>

#include "exchange/layers/friction_layers.hpp"
#include "speedmap/items/item_effects.hpp"
#include "speedmap/speeds/speed_map.hpp"

namespace roadbook {

/// Lowers the profiles (`apply_items`) and the cells where items hold. `grip` stays the one without
/// items. `friction` gives the grip that wet ground lowers.
void slow_by_items(SpeedMap& map,
                   const ItemEffects& effects,
                   const std::optional<FrictionMap>& friction);

}  // namespace roadbook
