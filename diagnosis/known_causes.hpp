#pragma once

#include "diagnosis/inference/diagnosis_result.hpp"
#include "diagnosis/readings.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Subtracts known effects (`--model`) from readings to which they are simply added: friction by
/// slip, speed, drying and temperature, bias and scale of ranges to beacons, feet along the line of
/// sight.
[[nodiscard]] DriveReadings without_known(DriveReadings readings, const EffectSizes& known);

/// Removes the known effects from the findings, except those that the fit took into account: the
/// effects that `without_known` subtracts, and detector.range. An effect, noise included, stays if
/// its size differs significantly from the known one (p < 0.01, corrected for the number of
/// effects). Its size and interval are then those of the difference, and the gain is that of large
/// samples. Other known effects are removed. Effects of one place stay unchanged,
/// since a model does not name the place. For known effects that were considered, `extended` has
/// the whole size.
void take_off_known(const EffectSizes& known, Diagnosis& found);

/// Adds a note to each known noise effect in `found`: its size is in addition to the known size,
/// because the noise tests include the known one.
void note_beyond_known(const EffectSizes& known, Diagnosis& found);

}  // namespace roadbook
