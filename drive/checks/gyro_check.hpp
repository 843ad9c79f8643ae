#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drive/problem_list.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

/// The motion that the wheels state, at about ten points a second.
class WheelTrace {
 public:
  /// Adds the next row; `t_ns` on the shared clock.
  void add(std::int64_t t_ns, const WheelReading& reading, const WheelModel& model);
  /// Way between two stamps, forwards plus backwards [m]; -1 where the trace does not cover
  /// them.
  [[nodiscard]] double way_m(std::int64_t first_ns, std::int64_t last_ns) const;

  struct Point {
    std::int64_t t_ns;
    double way_m;
    double heading_rad;
  };
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }

 private:
  std::vector<Point> points_;
  std::optional<WheelReading> before_;
  double way_m_ = 0.0;
  double heading_rad_ = 0.0;
};

/// Compares turn rates of a gyro with the turns by the wheels, over pieces of a second: a gyro in
/// degrees stays within plausible bounds on a gentle drive, but contradicts the wheels.
class GyroCheck {
 public:
  explicit GyroCheck(const WheelTrace& wheels) : wheels_(wheels) {}
  /// Adds a reading about the vehicle's z axis, in the order of time; `t_ns` on the shared clock.
  void add(std::int64_t t_ns, double rate_rad_s);
  /// Adds a warning if both are correlated (above 0.9, at least 20 pieces) and the gyro turns more
  /// than 2.5 times as far as the wheels, less than 0.4 times, or the other way.
  void report(const std::string& file, ProblemList& problems) const;

 private:
  void close_piece(double by_wheels_rad);
  const WheelTrace& wheels_;
  std::size_t next_ = 0;   ///< first point of the trace that the readings have not reached
  std::size_t begin_ = 0;  ///< point where the piece begins
  std::optional<std::int64_t> before_ns_;
  double before_rad_s_ = 0.0;
  double turned_rad_ = 0.0;  ///< in this piece
  bool covered_ = false;     ///< the gyro has readings since the piece began
  std::size_t pieces_ = 0;
  double wheels2_ = 0.0;  ///< sums of squares and products
  double gyro2_ = 0.0;
  double both_ = 0.0;
};

}  // namespace roadbook
