#pragma once

#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

// Effects far beyond their plausible size. A score test about the nominal fit cannot judge them,
// because that fit is far from the optimum.

/// Whether the nominal model leaves residuals that no linear step can judge, or a stream is off by
/// a factor or by seconds (`start_of_large_effects`), which the noise that is estimated may hide
/// from the residuals. `known`: effects that the nominal model holds.
[[nodiscard]] bool has_large_effects(const Observations& obs,
                                     const MotionModel& nominal,
                                     const EffectSizes& known,
                                     const LibraryOptions& library);

/// Sizes of catalogued effects, in addition to the known ones, that bring the model near the data.
/// The search is the same, but about the trajectory of the poses alone. Other streams get no more
/// weight than they fit; their noise falls from round to round as effects are found.
[[nodiscard]] EffectSizes large_effects_of(const Observations& obs,
                                           const EffectSizes& known,
                                           const LibraryOptions& library);

}  // namespace roadbook
