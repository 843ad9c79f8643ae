#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/trajectory.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// [s] beyond which a latency is no cause that is searched for.
inline constexpr double kFarthestLag = 5.0;

/// By how much [s] the readings of each stream are late against poses; 0 where that is in reach of
/// linear steps, none where it is not told.
struct StreamLags {
  std::optional<double> wheels, steering, gyro;
};

/// By cross-correlation with the motion of the poses: the lag within five seconds at which the
/// readings go with it best, whatever their scale, sign and offset (a parabola through the best of
/// a grid of knot intervals). Told where the motion then explains four fifths of the readings; out
/// of reach from a quarter of a second on, where it leaves at most half of what it leaves without
/// a lag. `motion`: of the poses, in true time; `known`: effects taken off first. Linear in the
/// drive.
[[nodiscard]] StreamLags gross_lags(const Observations& obs,
                                    const Trajectory& motion,
                                    const EffectSizes& known);

/// Lags [s] beyond `kFarthestLag`, to a quarter of a second: of streams of which the motion
/// explains four fifths there and leaves three times as much at any nearer one; none elsewhere.
/// Quadratic in the drive where a stream goes with the motion nowhere.
[[nodiscard]] StreamLags far_lags(const Observations& obs, const Trajectory& motion);

/// The lags as effects. Where all streams are late alike it is the poses that are early, unless
/// `cam.latency` is among the names left out; steering shares the wheels' clock.
[[nodiscard]] EffectSizes named_lags(const StreamLags& lags,
                                     const std::vector<std::string>& without);

/// The observations without those readings that show a time which the poses do not cover, given
/// the effects: no trajectory is known there.
[[nodiscard]] Observations covered_by_poses(Observations obs, const EffectSizes& effects);

}  // namespace roadbook
