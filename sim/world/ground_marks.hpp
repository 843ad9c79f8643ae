#pragma once

#include "sim/scenario/scenario.hpp"
#include "sim/world/layout.hpp"
#include "sim/world/paint.hpp"
#include "sim/world/row_work.hpp"

namespace roadbook {

// The strokes of the painted ground, in the order in which a real floor gets them.

/// Gravel beside the lanes, wet patches on them: brightness and kind.
void paint_road_surface(const Scenario& scenario,
                        Canvas& ground,
                        Canvas& kind,
                        const RowWork& rows);
/// Patches, cracks, tar seams, tyre marks: under the paint.
void paint_wear(const Scenario& scenario, const Layout& layout, Canvas& ground);
/// Lines, numbers, crossings, drain into a three-channel mask: coverage, brightness, wear.
void paint_markings(const Scenario& scenario, const Layout& layout, Canvas& mask);
/// Oil, gum, leaves: over the paint.
void paint_dirt(const Scenario& scenario, Canvas& ground);

}  // namespace roadbook
