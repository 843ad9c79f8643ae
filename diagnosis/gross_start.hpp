#pragma once

#include "diagnosis/observations.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Where a stream reads what the motion of the poses says times some factor below two thirds or
/// above one and a half, or of the other sign: sizes, beside `known`, of the effects that are such
/// factors (radii, track width, steering ratio, gyro scale). Empty if nothing is so far off.
///
/// In closed form, by regression of the readings on the poses' own motion. Linear steps from the
/// nominal model do not get there: readings go with one over the radius, and Newton's method on
/// that runs away from where a wheel turns more than twice as often as it should; and the noise of
/// a stream that is many times off is estimated so large that nobody listens to it any more.
/// Nothing is said of a stream of which this explains less than nine tenths. Linear in the drive.
[[nodiscard]] EffectSizes gross_start(const Observations& obs, const EffectSizes& known);

}  // namespace roadbook
