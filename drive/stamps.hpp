#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drive/problem_list.hpp"
#include "drive/stream_summary.hpp"

namespace roadbook {

/// Conditions on the stamps of a stream, in addition to ascending order.
struct StampLimits {
  double max_rate_hz = 20'000.0;  ///< a faster stream has its stamps in another unit
  double min_rate_hz = 0.005;     ///< so has a slower one
  double declared_rate_hz = 0.0;  ///< `rate_hz` of the sensor.yaml; 0: not stated
};

/// Checks the stamps of one stream, row by row: strictly ascending, rate believable, gaps.
class StampCheck {
 public:
  StampCheck(std::string file, ProblemList& problems);
  /// False (and an error) where the stamp repeats or goes back; such a row is to be skipped. Rows
  /// after a clock has gone back are one error, up to the first one later than all before.
  bool add(std::int64_t t_ns, std::int64_t line);
  /// Reports gaps as warnings and an absurd rate as error; call once, after the last row.
  StreamSummary finish(const std::string& stream, const StampLimits& limits);

 private:
  std::string file_;
  ProblemList& problems_;
  void close_step();
  ClockStep step_;  ///< rows that are not later than those before; rows 0: none
  std::vector<std::int64_t> stamps_;
  std::vector<std::int64_t> lines_;
};

/// Rows and median rate of stamps in any order, several of which may be the same; gaps are not
/// counted.
[[nodiscard]] StreamSummary summary_in_any_order(const std::string& stream,
                                                 std::vector<std::int64_t> stamps);

}  // namespace roadbook
