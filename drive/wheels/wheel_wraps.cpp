#include "drive/wheels/wheel_wraps.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include "sensors/counter_period.hpp"

namespace roadbook {
namespace {

std::vector<CounterValue> values_of(const std::vector<WheelCells>& rows, std::size_t side) {
  std::vector<CounterValue> values;
  values.reserve(rows.size());
  for (const WheelCells& row : rows) values.push_back({row.t_ns, row.wheel[side]});
  return values;
}

// The period of a column's counter [rad]: stated, or found from its values.
std::optional<double> period_of(const CounterColumn& column,
                                const WheelModel& model,
                                const std::vector<CounterValue>& values) {
  if (model.wraps_at > 0.0) return model.wraps_at * column.factor;
  if (!column.is_ticks) return counter_period(values, std::array{2.0 * std::numbers::pi}, 0.0);
  std::vector<CounterValue> ticks = values;
  for (CounterValue& v : ticks) v.value = std::round(v.value / column.factor);
  constexpr std::array kBits{0x1p8, 0x1p10, 0x1p12, 0x1p14, 0x1p15, 0x1p16, 0x1p24, 0x1p31, 0x1p32};
  const auto period = counter_period(ticks, kBits, model.ticks_per_turn);
  if (!period) return std::nullopt;
  return *period * column.factor;
}

bool is_usual(const CounterColumn& column, double period_rad) {
  if (!column.is_ticks) return std::abs(period_rad - 2.0 * std::numbers::pi) < 1e-6;
  const double ticks = std::round(period_rad / column.factor);
  return ticks == 0x1p16 || ticks == 0x1p32;
}

void report_wraps(const std::string& file,
                  const CounterColumn& column,
                  double period_rad,
                  const std::vector<WheelCells>& rows,
                  ProblemList& problems) {
  std::ostringstream period;
  period.precision(12);
  period << period_rad / column.factor;
  std::ostringstream got;
  got.precision(1);
  got << std::fixed << "values that start again at " << period.str() << " within "
      << static_cast<double>(rows.back().t_ns - rows.front().t_ns) * 1e-9 << " s; continued";
  problems.warning(file, 0, "counters", got.str(), "wraps_at: " + period.str() + " in sensor.yaml");
}

}  // namespace

void undo_wraps(const std::string& file,
                const std::array<CounterColumn, 2>& columns,
                const WheelModel& model,
                std::vector<WheelCells>& rows,
                ProblemList& problems) {
  std::array<std::optional<double>, 2> periods;
  for (std::size_t side = 0; side < 2; ++side)
    if (columns[side].counts)
      periods[side] = period_of(columns[side], model, values_of(rows, side));
  // The counters of one axle are alike: what one wheel shows too seldom the other one shows.
  const bool alike = columns[0].counts && columns[1].counts &&
                     columns[0].is_ticks == columns[1].is_ticks &&
                     columns[0].factor == columns[1].factor;
  for (std::size_t side = 0; side < 2; ++side)
    if (alike && !periods[side]) periods[side] = periods[1 - side];
  std::optional<std::size_t> unusual;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!periods[side]) continue;
    const auto continued = without_wraps(values_of(rows, side), *periods[side]);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].wheel[side] = continued[i];
    if (model.wraps_at == 0.0 && !is_usual(columns[side], *periods[side]) && !unusual)
      unusual = side;
  }
  if (unusual) report_wraps(file, columns[*unusual], *periods[*unusual], rows, problems);
}

}  // namespace roadbook
