#pragma once

#include "diagnosis/friction/friction_columns.hpp"
#include "diagnosis/friction/friction_noise.hpp"
#include "diagnosis/inference/innovations.hpp"

namespace roadbook {

/// Residual readings and columns (`sides`, one row a reading) with the means of the classes and the
/// bias of places taken out, and the noise made white.
[[nodiscard]] Innovations friction_innovations(const FrictionReadings& readings,
                                               const SurfaceClasses& classes,
                                               const PlaceCells& cells,
                                               const FrictionNoise& noise,
                                               const FrictionMean& sides);

}  // namespace roadbook
