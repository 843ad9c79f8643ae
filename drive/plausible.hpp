#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "drive/problem_list.hpp"
#include "sensors/rig.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Checks for values that no vehicle has. The usual cause is a unit other than the stated one. One
// table of bounds (plausible.cpp) serves sensor.yaml files and the columns of tables.

/// Compares the values of one column with a bound, and gives one message for the column.
class ColumnBound {
 public:
  /// `most`: largest absolute value, in the column's own unit; `want`: for the message.
  ColumnBound(std::string field, double most, std::string want)
      : field_(std::move(field)), most_(most), want_(std::move(want)) {}
  void add(double value, std::int64_t line);
  /// Largest absolute value so far.
  [[nodiscard]] double largest() const { return largest_; }
  /// Adds a warning with the largest value and the number of rows beyond the bound. It is an error
  /// if these are more than one and more than 5 % of all rows: then the column has another unit.
  /// `cause`: a possible cause, or empty. Returns whether there was something to report.
  bool report(const std::string& file, ProblemList& problems, const std::string& cause) const;

 private:
  std::string field_;
  double most_;
  std::string want_;
  double largest_ = 0.0;
  double worst_ = 0.0;
  std::int64_t worst_line_ = 0;
  std::size_t rows_ = 0;
  std::size_t beyond_ = 0;
};

/// "degrees?" if `value`, read as degrees, is within `most` [rad]; else empty.
[[nodiscard]] std::string degrees_cause(double value, double most);

/// Largest steering angle of a road wheel [rad]: the sharpest steering taxis reach 65 degrees.
inline constexpr double kMostSteering_rad = 1.2;
/// Turn rate of a vehicle [rad/s]: 570 degrees a second.
inline constexpr double kMostTurnRate_rad_s = 10.0;

/// Specific force of an IMU on a vehicle [m/s^2]: blows saturate the usual ones at 16 g.
inline constexpr double kMostForce_m_s2 = 500.0;

/// Checks the mean length of specific forces, which include gravity. For another mean than gravity,
/// adds a warning with the unit, or the missing gravity, that would explain it.
void check_mean_force(const std::string& file, double mean_m_s2, ProblemList& problems);

/// Checks the sizes of wheels and vehicle: errors for sizes that no vehicle has, warnings for rare
/// ones.
void check_wheel_sizes(const std::string& file, const WheelModel& wheels, ProblemList& problems);

/// Warns of a calibration that cannot belong to images of the stated size (principal point far from
/// the middle, focal length out of proportion), and of a camera without a pose on a vehicle.
void check_camera_sizes(const std::string& file,
                        const MountedCamera& camera,
                        ProblemList& problems);

/// Explains images of another size than the calibration: "half the size: ..." if both sides differ
/// by the same factor; else empty.
[[nodiscard]] std::string size_cause(std::int64_t got_width,
                                     std::int64_t got_height,
                                     std::int64_t want_width,
                                     std::int64_t want_height);

}  // namespace roadbook
