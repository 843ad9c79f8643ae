#pragma once

#include "diagnosis/inference/candidate.hpp"
#include "diagnosis/streams/observations.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Sizes of large effects in closed form: latencies of streams that read the poses' motion at quite
/// another time (`large_lags`), and factors below two thirds, above one and a half, or negative
/// (radii, track width, steering ratio, gyro scale). The sizes are in addition to `known`. Empty if
/// no effect is that large; effects that `library` leaves out are not returned.
/// Method: correlation and regression of the readings on the motion of the poses. Linear steps from
/// the nominal model do not reach such sizes. A motion of two seconds ago does not predict the
/// present one. Readings depend on one over the radius, where Newton's method diverges. The noise
/// of such a stream would be estimated so large that the stream loses all weight. A stream
/// gets no factor if the factor explains less than nine tenths of it. Cost: linear in the drive.
[[nodiscard]] EffectSizes start_of_large_effects(const Observations& obs,
                                                 const EffectSizes& known,
                                                 const LibraryOptions& library);

}  // namespace roadbook
