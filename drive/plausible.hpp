#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "drive/problem_list.hpp"
#include "sensors/rig.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Values that no vehicle has: nearly always another unit than the one that is stated. One table of
// bounds (plausible.cpp) for what sensor.yaml files state and for the columns of tables.

/// The values of one column, each compared with a bound; one message a column.
class ColumnBound {
 public:
  /// `most`: largest absolute value, in the column's own unit; `want`: for the message.
  ColumnBound(std::string field, double most, std::string want)
      : field_(std::move(field)), most_(most), want_(std::move(want)) {}
  void add(double value, std::int64_t line);
  /// Largest absolute value so far.
  [[nodiscard]] double largest() const { return largest_; }
  /// A warning that names the largest value and how many rows are beyond the bound; an error where
  /// they are more than one and more than 5 % of all: then the column is of another unit. `cause`
  /// is a guess, or empty. Whether there was something to report.
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

/// "degrees?" where `value` is within `most` if its unit were degrees; else empty.
[[nodiscard]] std::string degrees_cause(double value, double most);

/// Largest steering angle of a road wheel [rad]: the sharpest steering taxis reach 65 degrees.
inline constexpr double kMostSteering_rad = 1.2;
/// Turn rate of a vehicle [rad/s]: 570 degrees a second.
inline constexpr double kMostTurnRate_rad_s = 10.0;

/// Mean length of specific forces; a vehicle at rest or not feels gravity. A warning says which
/// unit, or which missing gravity, would explain another one.
void check_mean_force(const std::string& file, double mean_m_s2, ProblemList& problems);

/// Sizes of wheels and vehicle: errors for what no vehicle has, warnings for what few have.
void check_wheel_sizes(const std::string& file, const WheelModel& wheels, ProblemList& problems);

/// Warns of a calibration that cannot belong to images of the stated size (principal point far from
/// the middle, focal length out of proportion), and of a camera without a pose on a vehicle.
void check_camera_sizes(const std::string& file,
                        const MountedCamera& camera,
                        ProblemList& problems);

/// For images of `got` where a calibration is of `want`: "half the size: ..." where both sides
/// differ by one factor; else empty.
[[nodiscard]] std::string size_cause(std::int64_t got_width,
                                     std::int64_t got_height,
                                     std::int64_t want_width,
                                     std::int64_t want_height);

}  // namespace roadbook
