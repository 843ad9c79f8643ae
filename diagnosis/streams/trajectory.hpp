#pragma once

#include <cstddef>
#include <vector>

namespace roadbook {

/// Planar motion at one time.
struct MotionState {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
  double speed = 0.0;         ///< [m/s] along the vehicle
  double yaw_rate = 0.0;      ///< [rad/s]
  double acceleration = 0.0;  ///< [m/s^2] along the vehicle
  double distance_m = 0.0;    ///< integral of the speed since the first knot
  double turned = 0.0;        ///< heading change since the first knot
};

// A planar trajectory. Speed and yaw rate are linear between equidistant knots; poses are stored at
// the knots. Within an interval the vehicle rolls without lateral slip from the pose of its first
// knot. The next pose may differ from the end of that motion: lateral slip and noise.
class Trajectory {
 public:
  Trajectory() = default;
  Trajectory(double start_s, double step_s, std::size_t knots);

  [[nodiscard]] double start_s() const { return start_s_; }
  [[nodiscard]] double step_s() const { return step_s_; }
  [[nodiscard]] std::size_t knots() const { return speed.size(); }
  [[nodiscard]] double knot_s(std::size_t j) const;
  /// Index of the knot interval that contains `t_s`, clamped to the trajectory.
  [[nodiscard]] std::size_t interval(double t_s) const;
  /// State at `t_s`, extrapolated linearly beyond the ends. Call `integrate` after every change of
  /// the knots.
  [[nodiscard]] MotionState at(double t_s) const;
  /// The same without position: faster.
  [[nodiscard]] MotionState rates_at(double t_s) const;
  /// State `tau_s` seconds after knot j, with interval j extended.
  [[nodiscard]] MotionState after(std::size_t j, double tau_s) const;
  /// Recomputes the integrals of speed and yaw rate.
  void integrate();
  /// Shifts all knots in time.
  void begin_at(double start_s) { start_s_ = start_s; }

  std::vector<double> x, y, heading;  ///< at the knots
  std::vector<double> speed, yaw_rate;

 private:
  [[nodiscard]] MotionState rates_after(std::size_t j, double tau_s) const;
  double start_s_ = 0.0;
  double step_s_ = 0.08;
  std::vector<double> distance_, turned_;
};

/// The same poses with smoothed speed and yaw rate (cubic Savitzky-Golay filter over `half` knots
/// to either side, fewer at the ends). Covariates and derivatives are built from it, so that they
/// carry hardly any noise of the rows that they are compared with.
[[nodiscard]] Trajectory smoothed(const Trajectory& trajectory, std::size_t half = 4);

}  // namespace roadbook
