#pragma once

#include "diagnosis/friction/friction_columns.hpp"
#include "diagnosis/friction/friction_noise.hpp"
#include "diagnosis/inference/innovations.hpp"

namespace roadbook {

/// Whitened innovations of readings and columns (`sides`, one row a reading), with class means and
/// spatial bias projected out.
[[nodiscard]] Innovations friction_innovations(const FrictionReadings& readings,
                                               const SurfaceClasses& classes,
                                               const PlaceCells& cells,
                                               const FrictionNoise& noise,
                                               const FrictionMean& sides);

}  // namespace roadbook
