#pragma once

#include <optional>

#include "diagnosis/streams/observations.hpp"

namespace roadbook {

// Dead reckoning by wheels, gyro and steering over gaps of the poses, with the nominal vehicle and
// no effects. It provides the starting values of a fit.

/// Length of a gap of the poses [s]: 1 s, or three times the median interval of the poses if that
/// is longer. Poses ascend in time.
[[nodiscard]] double pose_gap_s(const std::vector<PoseSample>& poses);

/// Speed [m/s] at time t by the wheels; no value in a gap of the wheels. If only one wheel is read,
/// its own speed.
[[nodiscard]] std::optional<double> reckoned_speed(const Observations& obs, double t_s);

/// Yaw rate [rad/s] at time t: by the gyro; in a gap of the gyro by both wheels; else by steering
/// and speed. No value if none of them has readings.
[[nodiscard]] std::optional<double> reckoned_yaw_rate(const Observations& obs, double t_s);

/// Change of heading [rad] between two times. Intervals without readings count as straight.
[[nodiscard]] double reckoned_turn(const Observations& obs, double from_s, double to_s);

}  // namespace roadbook
