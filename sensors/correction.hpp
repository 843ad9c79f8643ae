#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sensors/effects.hpp"
#include "sensors/range.hpp"
#include "sensors/rig.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Known effects taken out again: calibration and readings as the nominal model would have had them.
// What `--model` does for estimation; simulation does the opposite with the same sizes.

/// The calibration that really holds where the effects of `sizes` are on: radii and track width
/// corrected. Stamps move by the wheels' latency, and with all that is no image by that of the
/// whole rig (`cam.latency`), by which images show what the other sensors have read before.
[[nodiscard]] WheelModel corrected_wheels(const WheelModel& nominal, const EffectSizes& sizes);
[[nodiscard]] RangeModel corrected_range(const RangeModel& nominal, const EffectSizes& sizes);
[[nodiscard]] Rig corrected_rig(const Rig& nominal, const EffectSizes& sizes);

/// What wheels and steering would have read with the radii of `corrected_wheels` and nothing else
/// wrong: eccentricity, slip under acceleration and growth with speed taken out, drifting stamps
/// put on the cameras' clock, which both agree on at `origin_ns`. Speed and acceleration are those
/// of the readings themselves over 0.4 s.
[[nodiscard]] std::vector<WheelReading> corrected_readings(const WheelModel& nominal,
                                                           const EffectSizes& sizes,
                                                           std::int64_t origin_ns,
                                                           std::vector<WheelReading> readings);

/// Stamp on the cameras' clock of one from a clock that drifts (`clock.drift`).
[[nodiscard]] std::int64_t corrected_stamp(const EffectSizes& sizes,
                                           std::int64_t origin_ns,
                                           std::int64_t t_ns);

/// Names in `sizes` that the functions above cannot take out of rig and wheels.
[[nodiscard]] std::vector<std::string> not_corrected(const EffectSizes& sizes);

}  // namespace roadbook
