#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace roadbook {

// Counters that start again. A wheel's angle that is given within one turn starts again at 360
// degrees, a tick counter of 12 bits at 4096.

/// One value of a counter, in the counter's unit.
struct CounterValue {
  std::int64_t t_ns = 0;
  double value = 0.0;
};

/// Finds the period at which a counter starts again, from its values in ascending order of time.
///
/// A jump is a step of more than half of the values' range. Each jump must fit one period: the
/// period then is the rate before and after the jump, less the jump. One of `known` is taken where
/// all jumps fit it. Else at least three jumps must agree within 2 %. Zeros amid a count (a logger
/// that receives nothing) are no jumps. A counter that a controller sets to zero at any value has
/// no period. `whole`: the values are whole numbers, and so is the period; a multiple of `whole`
/// units is preferred (0: the values are not whole).
/// Empty if the counter does not start again, or at no period.
[[nodiscard]] std::optional<double> counter_period(std::span<const CounterValue> values,
                                                   std::span<const double> known,
                                                   double whole);

/// Continues the values over each start at `period` > 0: every step becomes the one nearest to the
/// rate before it.
[[nodiscard]] std::vector<double> without_wraps(std::span<const CounterValue> values,
                                                double period);

}  // namespace roadbook
