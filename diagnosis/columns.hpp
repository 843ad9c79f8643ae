#pragma once

#include <vector>

#include "diagnosis/motion_fit.hpp"

namespace roadbook {

/// Changes of all rows by each of the named effects (indices into `motion_effects`) at a point:
/// central differences of the prediction itself, at the smoothed trajectory. Raw readings would
/// correlate with their own noise (errors in variables).
[[nodiscard]] Columns effect_columns(const Observations& obs,
                                     const MotionPoint& point,
                                     const std::vector<std::size_t>& effects);

/// Columns side by side.
[[nodiscard]] Columns joined(const Columns& a, const Columns& b, std::size_t rows);

}  // namespace roadbook
