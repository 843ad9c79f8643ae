#pragma once

#include <opencv2/core/mat.hpp>

#include "sim/scenario/scenario.hpp"
#include "sim/world/layout.hpp"
#include "sim/world/paint.hpp"
#include "sim/world/row_work.hpp"

namespace roadbook {

/// The painted ground: brightness, including light and shadows, and class of every texel.
struct PaintedGround {
  Canvas brightness;
  Canvas kind;   ///< SurfaceClass by value, coarser than the brightness
  Canvas light;  ///< light from lamps and openings, 128 = 1, every 0.25 m
};

/// Bakes asphalt, its wear, markings, numbers, crossings, drain, gravel, wet patches, shadows.
/// A pure function of the scenario, whatever the number of threads.
[[nodiscard]] PaintedGround paint_ground(const Scenario& scenario,
                                         const Layout& layout,
                                         const RowWork& rows);

}  // namespace roadbook
