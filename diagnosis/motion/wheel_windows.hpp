#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

// All readings of the wheels in windows of six, each reduced to three numbers that do not depend on
// place, speed and acceleration within the window. Noise of a reading affects one reading; scatter
// along the way accumulates. The two have different shares in the three numbers.

inline constexpr std::size_t kWheelWindow = 6;               ///< readings
inline constexpr std::size_t kWheelRows = kWheelWindow - 3;  ///< numbers left of a window

/// Unit combinations of a window's readings without a parabola, in which a walk has independent
/// parts.
using WheelContrasts = Eigen::Matrix<double, kWheelRows, kWheelWindow>;
[[nodiscard]] const WheelContrasts& wheel_contrasts();

/// Variances of the rows: `walk` times that of the distance or heading after a metre, plus `read`
/// times that of a wheel's reading.
struct WheelWindow {
  bool along = false;  ///< a distance, of the readings of the heading before it
  std::array<double, kWheelRows> rows{};
  std::array<double, kWheelRows> walk{};  ///< [m]; zero while the car stands
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

/// Needs two wheels that are read at least every 40 ms, and a gyro, which measures the motion; else
/// the result is empty. Distances also contain changes of acceleration, which are negligible after
/// a parabola is removed.
[[nodiscard]] WheelWindows wheel_windows(const Observations& obs, const MotionModel& model);

}  // namespace roadbook
