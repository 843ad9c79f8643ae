#pragma once

#include <vector>

#include "diagnosis/streams/motion_effects.hpp"
#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/trajectory.hpp"

namespace roadbook {

// What every row of the observations should read, given trajectory and effects: the one function
// that fits, tests and refits all rest on.

/// Time of the motion that a reading stamped t shows.
[[nodiscard]] double true_time(double stamp_s, double origin_s, double drift, double latency_s);

struct RowTimes {
  std::vector<double> wheels;  ///< of every reading
  std::vector<double> steering_begin, steering_end, gyro_begin, gyro_end;
  std::vector<double> poses;
};
[[nodiscard]] RowTimes row_times(const Observations& obs, const MotionEffects& effects);

/// Predictions of all rows, channels one after another as `Observations::offsets` says. Poses:
/// world x, world y, heading (turned into along and across by `pose_residuals`). Only the streams
/// in `streams` are computed; the rest stays 0. Slip is that of the accelerations of `smooth`
/// (`trajectory` itself where that is smooth): those from knot to knot of a fit are noise.
[[nodiscard]] std::vector<double> predict_rows(const Observations& obs,
                                               const Trajectory& trajectory,
                                               const MotionEffects& effects,
                                               unsigned streams,
                                               const Trajectory* smooth = nullptr);

/// Change of the pose rows per second of their latency, as `predict_rows` has them; other rows 0.
/// By the rates at each pose's moment, not by a difference of two moments: smoothed rates do not
/// lead from knot to knot, so that a difference over a knot would hold the jump there.
[[nodiscard]] std::vector<double> pose_rows_by_latency(const Observations& obs,
                                                       const Trajectory& trajectory,
                                                       const MotionEffects& effects);

/// Turns differences of world x and y in the pose rows into along and across the vehicle.
void turn_pose_rows(const Observations& obs,
                    const Trajectory& trajectory,
                    const MotionEffects& effects,
                    std::vector<double>& rows);

/// Read (observed) minus predicted, all rows, poses along and across.
[[nodiscard]] std::vector<double> row_residuals(const Observations& obs,
                                                const Trajectory& trajectory,
                                                const MotionEffects& effects);

/// Below this speed [m/s] a steering angle says nothing that the model could use: 0.4 m/s of a car,
/// a quarter of the mean square speed of what is slower.
[[nodiscard]] double least_steering_speed(const Trajectory& trajectory);

}  // namespace roadbook
