#pragma once

#include "diagnosis/inference/candidate.hpp"
#include "diagnosis/streams/observations.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Where a stream reads what the motion of the poses was at quite another time (`gross_lags`), or
/// that motion times some factor below two thirds or above one and a half, or of the other sign:
/// sizes, beside `known`, of the latencies and of the effects that are such factors (radii, track
/// width, steering ratio, gyro scale). Empty if nothing is so far off; nothing that `library`
/// leaves out.
///
/// In closed form, by correlation and regression of the readings on the poses' own motion. Linear
/// steps from the nominal model do not get there: a motion of two seconds ago tells nothing of that
/// of now; readings go with one over the radius, and Newton's method on that runs away from where a
/// wheel turns more than twice as often as it should; and the noise of a stream that is many times
/// off is estimated so large that nobody listens to it any more. Nothing is said of a stream of
/// which a factor explains less than nine tenths. Linear in the drive.
[[nodiscard]] EffectSizes gross_start(const Observations& obs,
                                      const EffectSizes& known,
                                      const LibraryOptions& library);

}  // namespace roadbook
