#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sensors/effects.hpp"
#include "sensors/range.hpp"
#include "sensors/rig.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Correction of known effects: the calibration and readings that the nominal model would have had.
// `--model` does this for estimation. Simulation adds the same effects with the same sizes.

/// Returns the wheel calibration that holds if the effects of `sizes` are on: corrected radii and
/// track width, and a time offset corrected by the wheels' latency. The latency of the whole rig
/// (`cam.latency`) also moves the stamps of all sensors other than cameras.
[[nodiscard]] WheelModel corrected_wheels(const WheelModel& nominal, const EffectSizes& sizes);
/// The same for a range sensor and for the cameras.
[[nodiscard]] RangeModel corrected_range(const RangeModel& nominal, const EffectSizes& sizes);
[[nodiscard]] Rig corrected_rig(const Rig& nominal, const EffectSizes& sizes);

/// Returns the readings that wheels and steering would have given with the radii of
/// `corrected_wheels` and no further effect. Removes eccentricity, slip under acceleration and
/// growth with speed. Moves stamps of a drifting clock to the cameras' clock; the clocks agree at
/// `origin_ns`. Speed and acceleration come from the readings themselves, over 0.4 s.
[[nodiscard]] std::vector<WheelReading> corrected_readings(const WheelModel& nominal,
                                                           const EffectSizes& sizes,
                                                           std::int64_t origin_ns,
                                                           std::vector<WheelReading> readings);

/// Converts a stamp of the drifting clock (`clock.drift`) to the cameras' clock. The clocks agree
/// at `origin_ns`.
[[nodiscard]] std::int64_t corrected_stamp(const EffectSizes& sizes,
                                           std::int64_t origin_ns,
                                           std::int64_t t_ns);

/// Returns the names in `sizes` that the functions above cannot correct.
[[nodiscard]] std::vector<std::string> not_corrected(const EffectSizes& sizes);

}  // namespace roadbook
