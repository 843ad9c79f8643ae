#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sensors/effects.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

// The parameters of a vehicle's calibration that a drive can show, as one vector of errors. An
// error is the real value minus the stated one.
//
// Five columns for each camera: turns about its x, y and z axis [rad], focal length (relative),
// time that its images are late by [s]. Then four columns of the wheels: radius (relative), right
// radius minus left radius (relative), track width (relative), time that the readings are late by
// [s].

inline constexpr int kColumnsOfCamera = 5;
inline constexpr int kColumnsOfWheels = 4;

enum class CalibrationKind {
  kPitch,             ///< turn about the camera's x axis
  kYaw,               ///< about its y axis
  kRoll,              ///< about its z axis
  kFocal,             ///< both focal lengths
  kImageDelay,        ///< an image stamped t shows the world at t - size
  kRadius,            ///< of both rear wheels
  kRadiusDifference,  ///< right minus left
  kTrackWidth,
  kWheelDelay,
};

/// One parameter.
struct CalibrationColumn {
  std::string name;  ///< of the effect: "cam1.rotation", "wheels0.radius"
  CalibrationKind kind = CalibrationKind::kYaw;
  int camera = -1;  ///< -1: of the wheels

  [[nodiscard]] bool is_delay() const {
    return kind == CalibrationKind::kImageDelay || kind == CalibrationKind::kWheelDelay;
  }
  [[nodiscard]] bool is_turn() const {
    return kind == CalibrationKind::kPitch || kind == CalibrationKind::kYaw ||
           kind == CalibrationKind::kRoll;
  }
};

/// The columns of a rig, and of wheels if there are any, in the order above.
[[nodiscard]] std::vector<CalibrationColumn> calibration_columns(const Rig& rig, bool has_wheels);

/// Standard deviation of a column before the drive. For the columns that are
/// needed it is so wide that it only limits columns that are not observable: turns 0.1 rad, wheel
/// radius 0.2, delays 0.1 s. For the others it is the usual error of stated values: focal length 2
/// %, radius difference 0.3 %, track width 2 %.
[[nodiscard]] double prior_sigma(CalibrationKind kind);

/// Largest half width of a 95 % interval of an observable column: turns 0.4 degrees,
/// radius and focal length 0.5 %, radius difference 0.4 %, track width 2 %, delays of images 10 ms,
/// of wheels 20 ms.
[[nodiscard]] double widest_interval(CalibrationKind kind);

/// True for columns without which there is no calibration: turns, wheel radius and delays. The
/// other columns stay as stated where they are not observable.
[[nodiscard]] bool is_needed(CalibrationKind kind);

/// How to drive so that the column is observable: "turns to both sides".
[[nodiscard]] std::string manoeuvre_for(CalibrationKind kind);

/// Turns of a camera about its own axes, R_stated * exp(turn), as the three effects "pitch",
/// "rotation" and "roll" (camera_effects.hpp).
struct CameraTurn {
  double pitch = 0.0;
  double yaw = 0.0;
  double roll = 0.0;
};
[[nodiscard]] CameraTurn turn_of(const Eigen::Vector3d& rotation_vector);
[[nodiscard]] Eigen::Vector3d rotation_vector_of(const CameraTurn& turn);

}  // namespace roadbook
