#pragma once

#include <vector>

#include "diagnosis/streams/motion_effects.hpp"
#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/trajectory.hpp"

namespace roadbook {

// Predicted readings of all rows, given trajectory and effects. Fits, tests and refits all use this
// one function.

/// True time [s] of the motion that a reading stamped `stamp_s` measures.
[[nodiscard]] double true_time(double stamp_s, double origin_s, double drift, double latency_s);

struct RowTimes {
  std::vector<double> wheels;  ///< one a reading
  std::vector<double> steering_begin, steering_end, gyro_begin, gyro_end;
  std::vector<double> poses;
};
[[nodiscard]] RowTimes row_times(const Observations& obs, const MotionEffects& effects);

/// Predictions of all rows, in the order of `Observations::offsets`. Pose rows are x, y and heading
/// in the world frame; `turn_pose_rows` converts differences to the vehicle frame. Only streams in
/// the bit mask `streams` are computed; the rest stays 0.
///
/// `smooth`: trajectory whose accelerations determine the slip; null if `trajectory` itself is
/// smooth. The accelerations of a fitted trajectory from knot to knot are mostly noise.
[[nodiscard]] std::vector<double> predict_rows(const Observations& obs,
                                               const Trajectory& trajectory,
                                               const MotionEffects& effects,
                                               unsigned streams,
                                               const Trajectory* smooth = nullptr);

/// Derivative of the pose rows by their latency [1/s], in the layout of `predict_rows`; other rows
/// 0. It uses the rates at the time of each pose. A difference of two times would include the jump
/// between a knot's pose and the smoothed rates before it.
[[nodiscard]] std::vector<double> pose_rows_by_latency(const Observations& obs,
                                                       const Trajectory& trajectory,
                                                       const MotionEffects& effects);

/// Rotates differences of pose rows from world x and y to along and across the vehicle.
void turn_pose_rows(const Observations& obs,
                    const Trajectory& trajectory,
                    const MotionEffects& effects,
                    std::vector<double>& rows);

/// Observed minus predicted, all rows; poses along and across the vehicle.
[[nodiscard]] std::vector<double> row_residuals(const Observations& obs,
                                                const Trajectory& trajectory,
                                                const MotionEffects& effects);

/// Speed [m/s] below which steering angles are ignored: 0.4 m/s, or for slower vehicles half
/// of the root mean square speed.
[[nodiscard]] double least_steering_speed(const Trajectory& trajectory);

}  // namespace roadbook
