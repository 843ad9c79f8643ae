#pragma once

#include <optional>

#include "diagnosis/streams/observations.hpp"

namespace roadbook {

// What wheels, gyro and steering say of the motion where no pose does: good enough to start a fit
// from, nominal vehicle, no effects.

/// Seconds without poses that count as a gap: longer than one, and than three usual distances of
/// poses that ascend in time.
[[nodiscard]] double pose_gap_s(const std::vector<PoseSample>& poses);

/// Speed [m/s] at t by the wheels; none where they have a gap. Of one wheel its own.
[[nodiscard]] std::optional<double> reckoned_speed(const Observations& obs, double t_s);

/// Yaw rate [rad/s] at t: by the gyro, where it has a gap by both wheels, else by steering and
/// speed; none where none of them reads.
[[nodiscard]] std::optional<double> reckoned_yaw_rate(const Observations& obs, double t_s);

/// Turn [rad] between two moments; what nothing reads counts as straight.
[[nodiscard]] double reckoned_turn(const Observations& obs, double from_s, double to_s);

}  // namespace roadbook
