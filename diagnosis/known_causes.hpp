#pragma once

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// What the model knows (`--model`) taken off the readings that it is simply added to: friction by
/// slip, speed, drying and temperature, bias and scale of ranges to beacons, feet along the sight.
[[nodiscard]] DriveReadings without_known(DriveReadings readings, const EffectSizes& known);

/// Takes from findings what a model knows already, where the fit knew nothing of it (all but what
/// `without_known` takes off the readings, and detector.range, which the fit begins with): a
/// cause whose size differs surely from the known one (p < 0.01, corrected for the names looked
/// for; noise included) stays with the difference, size and interval less what is known, and the
/// gain of large samples; any other goes. What acts in one place stays as it is, since a model does
/// not say which. Of those known that were looked for
/// `extended` has the whole size.
void take_off_known(const EffectSizes& known, Diagnosis& found);

/// Says of noise that a model knows that only what is beyond that is meant: its tests know it.
void note_beyond_known(const EffectSizes& known, Diagnosis& found);

}  // namespace roadbook
