#pragma once

#include <Eigen/Core>
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

/// One reading of a whole IMU in the vehicle frame as stated (`T_BS`).
struct ImuSample {
  double t_s = 0.0;
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero();  ///< acceleration less gravity
};

/// Slope and bank of a vehicle at one time, from a reference in three dimensions.
struct Attitude {
  double t_s = 0.0;
  double slope_rad = 0.0;  ///< of the road ahead: positive uphill
  double bank_rad = 0.0;   ///< roll about the direction of travel: positive to the right side down
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
  /// All axes of the IMU that `gyro` is the levelled z axis of, one for each of its samples; empty
  /// where only one axis is known.
  std::vector<ImuSample> imu;
  std::vector<Attitude> body;  ///< by the reference; empty where that is planar
  bool bank_is_known = false;  ///< by the reference; else bends may be banked (`ground.bank`)
  /// Further logged columns: covariates of the generic effects. Their names differ from those of
  /// the built-in covariates.
  std::vector<LoggedColumn> columns;
};

}  // namespace roadbook
