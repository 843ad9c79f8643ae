#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/random.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/world/ground.hpp"
#include "sim/world/path.hpp"

namespace roadbook {

/// State of the car at one moment; position of the rear axle's middle on the ground.
struct VehicleState {
  double t_s = 0.0;
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;       ///< of the x axis, unwrapped
  double speed = 0.0;         ///< [m/s] along the car, on the surface
  double acceleration = 0.0;  ///< [m/s^2]
  double yaw_rate = 0.0;      ///< [rad/s] about the car's vertical axis
  double steering = 0.0;      ///< [rad] at the road wheels
  double distance_m = 0.0;    ///< driven so far, on the surface
  double turned = 0.0;        ///< integral of yaw_rate [rad]
  double height_m = 0.0;      ///< of the ground there: which storey
};

/// A whole drive as states at equal times.
class VehicleMotion {
 public:
  VehicleMotion(std::vector<VehicleState> states, const Ground& ground, const VehicleSpec& vehicle);

  [[nodiscard]] double duration_s() const { return states_.back().t_s; }
  /// State at t, linear between the stored ones; the car is at rest before and after the drive.
  [[nodiscard]] VehicleState at(double t_s) const;
  [[nodiscard]] Eigen::Isometry3d T_world_vehicle(double t_s) const;
  [[nodiscard]] const std::vector<VehicleState>& states() const { return states_; }

 private:
  std::vector<VehicleState> states_;
  Ground ground_;
  VehicleSpec vehicle_;
  double step_s_;
};

struct DriverOptions {
  double lateral_slip_per_sqrt_m = 0.0;  ///< standard deviation of lateral slip [m] after 1 m
  bool wander = true;                    ///< the driver deviates from the lane's centre
};

/// Drives `laps` times along `line`: pure pursuit with limited steering and steering rate, speed
/// limited by the bends ahead, by acceleration and braking, and by the stops. Starts and ends at
/// rest. On a closed line a few metres more are driven, so that the drive meets its own beginning.
[[nodiscard]] VehicleMotion drive_line(const DrivingLine& line,
                                       int laps,
                                       const std::vector<StopSpec>& stops,
                                       const VehicleSpec& vehicle,
                                       const Ground& ground,
                                       const DriverOptions& options,
                                       Random& random);

}  // namespace roadbook
