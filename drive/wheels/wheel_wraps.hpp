#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drive/problem_list.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

/// A row of the wheels' table with both wheels.
struct WheelCells {
  std::int64_t t_ns = 0;
  std::int64_t line = 0;
  std::array<double, 2> wheel{};  ///< left and right: angle [rad], or speed [rad/s]
  std::optional<double> steering_rad;
};

/// What a wheel's column counts.
struct CounterColumn {
  bool counts = false;    ///< false: speeds, which are no counts
  bool is_ticks = false;  ///< else angles
  double factor = 1.0;    ///< radians a unit of the column
};

/// Continues the angles of both wheels over each start of their counters
/// (sensors/counter_period.hpp). The period is `wraps_at` of the model, or found from the values.
/// One warning says a period that was found, except that of angles within one turn and of counters
/// with 16 or 32 bits, which are usual.
void undo_wraps(const std::string& file,
                const std::array<CounterColumn, 2>& columns,
                const WheelModel& model,
                std::vector<WheelCells>& rows,
                ProblemList& problems);

}  // namespace roadbook
