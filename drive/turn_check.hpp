#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "drive/problem_list.hpp"

namespace roadbook {

/// Looks for turns of a wheel that no car drives. A few are warnings (the map bridges such a row,
/// but the table is damaged); more than two and more than 5 % of the rows are one error: then the
/// column or the wheel's size is of another unit.
class TurnCheck {
 public:
  TurnCheck(std::string wheel, double radius_m) : wheel_(std::move(wheel)), radius_m_(radius_m) {}
  /// The wheel turned by `turn_rad` in the `dt_s` before the row of this line.
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
