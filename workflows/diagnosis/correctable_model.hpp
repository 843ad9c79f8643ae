#pragma once

#include "diagnosis/inference/diagnosis_result.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// The model that `--write-model` writes: `d.extended`, with effects that `--model` corrects where
/// a drive cannot separate them from effects that it does not correct.
///
/// Ground that is higher than stated and cameras that are mounted lower change the same readings
/// (ground.height and cam.height; ground.slope and rig.pitch). A map measures the ground with its
/// cameras, so the effect of the cameras is what a map can be corrected for.
[[nodiscard]] EffectSizes correctable_model(const Diagnosis& d);

}  // namespace roadbook
