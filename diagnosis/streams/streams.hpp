#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/logged_column.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// What diagnosis looks at: plain samples, wherever they come from. Times are seconds from any
// common origin; each stream ascends.

struct PoseSample {
  double t_s = 0.0;
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;  ///< [rad], any branch
};

struct WheelSample {
  double t_s = 0.0;
  double left_rad = 0.0;  ///< cumulative angle
  double right_rad = 0.0;
};

struct SteeringSample {
  double t_s = 0.0;
  double angle_rad = 0.0;  ///< at the road wheels
};

struct GyroSample {
  double t_s = 0.0;
  double rate_rad_s = 0.0;  ///< about the vehicle's z axis
};

/// Which wheels the samples of wheels show: both of the rear axle, or one speed, which tells
/// nothing of the wheels' difference: the vehicle's middle, one rear wheel, or a steered front
/// wheel.
enum class WheelsRead { kBoth, kMiddle, kLeft, kRight, kFront };

/// The streams of one drive that tell of planar motion; any of them may be empty but the poses.
struct MotionStreams {
  WheelModel wheel_model;
  WheelsRead wheels_read = WheelsRead::kBoth;  ///< one: its angle stands in both of a sample
  bool poses_have_heading = true;  ///< else that of a sample is a first guess, the course
  /// Poses of a map: neighbours share their errors, which no term of the grammar is asked to
  /// explain.
  bool poses_of_map = false;
  std::vector<PoseSample> poses;
  std::vector<WheelSample> wheels;
  std::vector<SteeringSample> steering;
  std::vector<GyroSample> gyro;
  /// What else was logged: covariates of the grammar, by names that are not the grammar's own.
  std::vector<LoggedColumn> columns;
};

}  // namespace roadbook
