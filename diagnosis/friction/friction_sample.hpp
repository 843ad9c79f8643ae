#pragma once

namespace roadbook {

/// One friction reading with all quantities that it may depend on.
struct FrictionSample {
  double t_s = 0.0;
  double friction = 0.0;
  double sigma = 0.05;         ///< stated
  int surface = 0;             ///< surface class under the wheels, labelled or inferred
  double temperature_c = 0.0;  ///< kFrictionReference if no temperature is logged
  double x = 0.0, y = 0.0, heading = 0.0;
  double speed = 0.0;                 ///< [m/s]
  double acceleration = 0.0;          ///< longitudinal [m/s^2]
  double lateral_acceleration = 0.0;  ///< to the left [m/s^2]
  double yaw_rate = 0.0;              ///< [rad/s]
};

}  // namespace roadbook
