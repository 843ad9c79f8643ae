#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "drive/problem_list.hpp"

namespace roadbook {

/// Finds wheel turns that are too fast for a car. A few give warnings: the map bridges such rows,
/// but the table is damaged. More than two, and more than 5 % of the rows, give one error: then the
/// column or the wheel's size has another unit.
class TurnCheck {
 public:
  TurnCheck(std::string wheel, double radius_m) : wheel_(std::move(wheel)), radius_m_(radius_m) {}
  /// Adds a row: the wheel turned by `turn_rad` in the time `dt_s` before it. `line`: in the file.
  void add(double turn_rad, double dt_s, std::int64_t line);
  void report(const std::string& file, ProblemList& problems) const;

 private:
  std::string wheel_;
  double radius_m_;
  std::size_t rows_ = 0;
  std::size_t count_ = 0;
  std::vector<std::pair<std::int64_t, std::string>> first_;  ///< lines and turns, not all
};

}  // namespace roadbook
