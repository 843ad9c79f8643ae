#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/logged_column.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// The samples that diagnosis works on, independent of their file format. Times are seconds from a
// common origin; each stream ascends.

struct PoseSample {
  double t_s = 0.0;
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;  ///< [rad], need not be wrapped or unwrapped
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

/// Which wheels are measured: both of the rear axle, or a single speed: the middle of the axle, one
/// rear wheel, or a steered front wheel. A single speed contains no difference of the wheels.
enum class WheelsRead { kBoth, kMiddle, kLeft, kRight, kFront };

/// The streams of planar motion of one drive. All but the poses may be empty.
struct MotionStreams {
  WheelModel wheel_model;
  WheelsRead wheels_read = WheelsRead::kBoth;  ///< a single one: both angles of a sample are equal
  bool poses_have_heading = true;              ///< else it is derived from the direction of travel
  /// The poses come from a map. Neighbouring poses then share errors, and no generic effect of
  /// poses is searched for.
  bool poses_of_map = false;
  std::vector<PoseSample> poses;
  std::vector<WheelSample> wheels;
  std::vector<SteeringSample> steering;
  std::vector<GyroSample> gyro;
  /// Further logged columns: covariates of the generic effects. Their names differ from those of
  /// the built-in covariates.
  std::vector<LoggedColumn> columns;
};

}  // namespace roadbook
