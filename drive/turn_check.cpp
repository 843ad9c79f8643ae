#include "drive/turn_check.hpp"

#include <sstream>

#include "drive/wheel_counter.hpp"

namespace roadbook {

void TurnCheck::add(double turn_rad, double dt_s, std::int64_t line) {
  ++rows_;
  if (!is_faster_than_cars(turn_rad * radius_m_, dt_s)) return;
  ++count_;
  if (first_.size() > ProblemList::kMaxPerFile) return;
  std::ostringstream got;
  got << "a turn of " << turn_rad << " rad in " << dt_s << " s";
  first_.emplace_back(line, got.str());
}

void TurnCheck::report(const std::string& file, ProblemList& problems) const {
  constexpr double kManyRows = 0.05;
  if (count_ > 2 && static_cast<double>(count_) > kManyRows * static_cast<double>(rows_))
    return problems.error(file, first_.front().first, wheel_,
                          first_.front().second + ", and the like in " + std::to_string(count_) +
                              " of " + std::to_string(rows_) + " rows",
                          "less than a car at 70 m/s (unit of the column, ticks_per_turn or "
                          "wheel_radius?)");
  for (const auto& [line, got] : first_)
    problems.warning(file, line, wheel_, got, "less than a car at 70 m/s");
}

}  // namespace roadbook
