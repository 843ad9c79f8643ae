#pragma once

#include <cstddef>
#include <vector>

namespace roadbook {

/// Planar motion at one moment.
struct MotionState {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
  double speed = 0.0;         ///< [m/s] along the vehicle
  double yaw_rate = 0.0;      ///< [rad/s]
  double acceleration = 0.0;  ///< [m/s^2] along the vehicle
  double distance_m = 0.0;    ///< integral of the speed since the first knot
  double turned = 0.0;        ///< integral of the yaw rate since the first knot
};

// A planar trajectory: speed and yaw rate linear between knots at equal times, poses at the knots.
// Between two knots the vehicle rolls without side slip from the first one's pose; a pose may
// differ from where the interval before it ends (creep).
class Trajectory {
 public:
  Trajectory() = default;
  Trajectory(double start_s, double step_s, std::size_t knots);

  [[nodiscard]] double start_s() const { return start_s_; }
  [[nodiscard]] double step_s() const { return step_s_; }
  [[nodiscard]] std::size_t knots() const { return speed.size(); }
  [[nodiscard]] double knot_s(std::size_t j) const;
  /// Index of the interval that holds t, within the trajectory.
  [[nodiscard]] std::size_t interval(double t_s) const;
  /// Extrapolated linearly beyond the ends. `integrate` must have been called after a change.
  [[nodiscard]] MotionState at(double t_s) const;
  /// The same without position: no sines, for readings that show none.
  [[nodiscard]] MotionState rates_at(double t_s) const;
  /// State `tau` seconds after knot j as interval j goes on.
  [[nodiscard]] MotionState after(std::size_t j, double tau_s) const;
  /// Renews the integrals of speed and yaw rate.
  void integrate();
  /// Moves all knots in time.
  void begin_at(double start_s) { start_s_ = start_s; }

  std::vector<double> x, y, heading;  ///< at the knots
  std::vector<double> speed, yaw_rate;

 private:
  [[nodiscard]] MotionState rates_after(std::size_t j, double tau_s) const;
  double start_s_ = 0.0;
  double step_s_ = 0.08;
  std::vector<double> distance_, turned_;
};

/// The same poses with speed and yaw rate smoothed (cubic Savitzky-Golay over `half` knots on
/// either side, fewer at the ends): what covariates and columns are built from, so that they carry
/// next to nothing of the noise of the rows they are compared with.
[[nodiscard]] Trajectory smoothed(const Trajectory& trajectory, std::size_t half = 4);

}  // namespace roadbook
