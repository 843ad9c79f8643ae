#include "sensors/counter_period.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr double kAgree = 0.02;  // of the period

struct Jump {
  std::size_t row = 0;    // behind the jump
  double size = 0.0;      // of the period that explains it
  double expected = 0.0;  // the step that the rate around it gives
};

double seconds(std::span<const CounterValue> values, std::size_t row) {
  return static_cast<double>(values[row].t_ns - values[row - 1].t_ns) * 1e-9;
}

double step(std::span<const CounterValue> values, std::size_t row) {
  return values[row].value - values[row - 1].value;
}

// Mean rate times the time of the row's step, over the steps beside it that are no jumps.
double expected_step(std::span<const CounterValue> values, std::size_t row, double jump_from) {
  double turned = 0.0;
  double time_s = 0.0;
  for (const std::size_t beside : {row - 1, row + 1}) {
    if (beside < 1 || beside >= values.size()) continue;
    if (std::abs(step(values, beside)) > jump_from) continue;
    turned += step(values, beside);
    time_s += seconds(values, beside);
  }
  return time_s > 0.0 ? turned / time_s * seconds(values, row) : 0.0;
}

// A logger that receives nothing writes the same value until it receives again.
bool is_dropout(std::span<const CounterValue> values,
                std::size_t out,
                std::size_t back,
                double jump_from) {
  constexpr std::int64_t kLongestNs = 2'000'000'000;
  if (values[back].t_ns - values[out].t_ns > kLongestNs) return false;
  for (std::size_t i = out; i < back; ++i)
    if (values[i].value != 0.0) return false;
  const double gap = std::abs(values[back].value - values[out - 1].value);
  return gap < 0.5 * jump_from;
}

std::vector<Jump> jumps_of(std::span<const CounterValue> values, double range) {
  const double jump_from = 0.5 * range;
  std::vector<std::size_t> rows;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (std::abs(step(values, i)) > jump_from) rows.push_back(i);
  std::vector<Jump> jumps;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k + 1 < rows.size() && is_dropout(values, rows[k], rows[k + 1], jump_from)) {
      ++k;
      continue;
    }
    const double expected = expected_step(values, rows[k], jump_from);
    jumps.push_back({rows[k], std::abs(expected - step(values, rows[k])), expected});
  }
  return jumps;
}

bool fits(const std::vector<Jump>& jumps, double range, double period, double least) {
  if (range > period * (1.0 + 1e-9)) return false;
  return std::all_of(jumps.begin(), jumps.end(), [&](const Jump& jump) {
    const double slack = std::max(least, 2.0 * std::abs(jump.expected) + 1e-3 * period);
    return std::abs(jump.size - period) <= std::min(slack, 0.25 * period);
  });
}

// Whether the values ran through their range between the jumps. A tick that flickers does not.
bool runs_through(std::span<const CounterValue> values, double range) {
  double run = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (std::abs(step(values, i)) <= 0.5 * range) run += std::abs(step(values, i));
  return run >= range;
}

// Whole turns, a power of two, a round number: in this order, where one lies near the mean.
double nice_period(double mean, double slack, double range, double whole) {
  for (const double nice :
       {std::round(mean / whole) * whole, std::exp2(std::round(std::log2(mean))),
        std::round(mean / 100.0) * 100.0})
    if (nice > range && std::abs(nice - mean) <= slack) return nice;
  return std::max(std::round(mean), range + 1.0);
}

}  // namespace

std::optional<double> counter_period(std::span<const CounterValue> values,
                                     std::span<const double> known,
                                     double whole) {
  if (values.size() < 3) return std::nullopt;
  const auto less = [](const CounterValue& a, const CounterValue& b) { return a.value < b.value; };
  const auto [low, high] = std::minmax_element(values.begin(), values.end(), less);
  const double range = high->value - low->value;
  const auto jumps = jumps_of(values, range);
  if (jumps.empty()) return std::nullopt;
  for (const double period : known)
    if (fits(jumps, range, period, whole > 0.0 ? 3.0 : 0.0)) return period;
  constexpr std::size_t kFewest = 3;
  if (jumps.size() < kFewest || !runs_through(values, range)) return std::nullopt;
  double mean = 0.0;
  for (const Jump& jump : jumps) mean += jump.size / static_cast<double>(jumps.size());
  double worst = 0.0;
  for (const Jump& jump : jumps) worst = std::max(worst, std::abs(jump.size - mean));
  if (worst > std::max(kAgree * mean, whole > 0.0 ? 3.0 : 0.0) || range > mean * (1.0 + kAgree))
    return std::nullopt;
  return whole > 0.0 ? nice_period(mean, worst + 1.0, range, whole) : std::max(mean, range);
}

std::vector<double> without_wraps(std::span<const CounterValue> values, double period) {
  constexpr double kMemoryS = 0.1;  // of the rate: rows may follow each other closely
  std::vector<double> continued;
  double rate = 0.0;
  double wraps = 0.0;  // whole; sums of steps would round at each row
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0) {
      continued.push_back(values[0].value);
      continue;
    }
    const double dt_s = seconds(values, i);
    const double expected = std::clamp(rate * dt_s, -0.4 * period, 0.4 * period);
    const double turned = expected + std::remainder(step(values, i) - expected, period);
    if (dt_s > 0.0) rate += std::min(1.0, dt_s / kMemoryS) * (turned / dt_s - rate);
    wraps += std::round((turned - step(values, i)) / period);
    continued.push_back(values[i].value + wraps * period);
  }
  return continued;
}

}  // namespace roadbook
