#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/trajectory.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// [s] largest lag that is searched for as a latency.
inline constexpr double kFarthestLag = 5.0;

/// Lag [s] of the readings of each stream relative to the poses, positive if late. 0: small enough
/// for the linear steps of the fit. No value: cannot be determined.
struct StreamLags {
  std::optional<double> wheels, steering, gyro;
};

/// Large lags by cross-correlation with the motion of the poses, within five seconds. The lag is
/// that at which a line in the motion explains most of the readings' variance, whatever their
/// scale, sign and offset. It is refined by a parabola through the best of a grid of knot
/// intervals. A lag is determined if the motion then explains at least four fifths of the readings.
/// It is reported from a quarter of a second on, and if it at least halves the residual variance.
///
/// `motion`: trajectory of the poses in true time. `known`: effects that are removed first. Linear
/// in the length of the drive.
[[nodiscard]] StreamLags large_lags(const Observations& obs,
                                    const Trajectory& motion,
                                    const EffectSizes& known);

/// Lags [s] beyond `kFarthestLag`, to a quarter of a second. A stream has one if the motion
/// explains four fifths of its readings there and leaves three times as much residual variance at
/// every smaller lag. Quadratic in the length of the drive if a stream matches the motion nowhere.
[[nodiscard]] StreamLags far_lags(const Observations& obs, const Trajectory& motion);

/// The lags as latency effects. If all streams are late by the same amount, the poses are early
/// (`cam.latency`), unless `without` lists that effect. Steering shares the clock of the wheels.
[[nodiscard]] EffectSizes named_lags(const StreamLags& lags,
                                     const std::vector<std::string>& without);

/// The observations without readings that, given the effects, show times outside the poses. The
/// trajectory is unknown there.
[[nodiscard]] Observations covered_by_poses(Observations obs, const EffectSizes& effects);

}  // namespace roadbook
