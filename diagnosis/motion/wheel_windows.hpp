#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

// Every reading of the wheels in windows of six, each as three numbers into which neither place nor
// speed nor acceleration of the window enters. The noise of a reading is there for one reading,
// what the wheels scatter on their way stays: of the three the two have different shares.

inline constexpr std::size_t kWheelWindow = 6;               ///< readings
inline constexpr std::size_t kWheelRows = kWheelWindow - 3;  ///< what is left of them

/// Unit combinations of a window's readings without a parabola, in which a walk has independent
/// parts.
using WheelContrasts = Eigen::Matrix<double, kWheelRows, kWheelWindow>;
[[nodiscard]] const WheelContrasts& wheel_contrasts();

/// Variances of the rows: `walk` times that of the distance or heading after a metre, plus `read`
/// times that of a wheel's reading.
struct WheelWindow {
  bool along = false;  ///< a distance, of the readings of the heading before it
  std::array<double, kWheelRows> rows{};
  std::array<double, kWheelRows> walk{};  ///< [m]; none where the car stands
  double read = 1.0;
  double readings = static_cast<double>(kWheelWindow);  ///< of one wheel, or of both
  double speed = 0.0;                                   ///< [m/s], without its sign
  double turn = 0.0;                                    ///< [rad/s], without its sign
  [[nodiscard]] double square(std::size_t row) const { return rows[row] * rows[row]; }
};

struct WheelWindows {
  /// Moving: of the wheels' mean as a distance [m^2] and of their difference as a heading [rad^2];
  /// standing: of each wheel's angle [rad^2].
  std::vector<WheelWindow> windows;
  /// Mean difference of neighbours among all different steps from reading to reading [rad]: the
  /// tick of an encoder, else next to nothing.
  double tick_rad = 0.0;
};

/// Needs two wheels read at least every 40 ms, and a gyro, which tells what is motion: empty
/// otherwise. Distances hold what the car speeds up by as well, next to nothing without a parabola.
[[nodiscard]] WheelWindows wheel_windows(const Observations& obs, const MotionModel& model);

}  // namespace roadbook
