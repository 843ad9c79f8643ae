#pragma once

#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

// Causes far beyond their plausible size: a first guess of a scale that is several times off, of
// which a score test about the nominal fit says nothing, since that fit is nowhere near.

/// Whether the nominal model leaves residuals that no linear step can judge, or a stream is off by
/// a factor or by seconds (`gross_start`), which the noise that is estimated may hide from the
/// residuals. `known`: effects that the nominal model holds.
[[nodiscard]] bool is_gross(const Observations& obs,
                            const MotionModel& nominal,
                            const EffectSizes& known,
                            const LibraryOptions& library);

/// Sizes of named effects, beside those known, that bring the model near the data. Found by the
/// same search about the trajectory of the poses alone, the other streams believed no better than
/// they fit it: their noise falls from round to round as causes are found.
[[nodiscard]] EffectSizes gross_causes(const Observations& obs,
                                       const EffectSizes& known,
                                       const LibraryOptions& library);

}  // namespace roadbook
