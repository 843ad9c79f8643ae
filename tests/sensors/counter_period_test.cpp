#include "sensors/counter_period.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr std::array kBits{0x1p12, 0x1p16, 0x1p24, 0x1p32};

// Units that a wheel has turned at row i: it speeds up, drives, stops, and drives on.
double turned(int i, double per_row) {
  const double rows = i < 100   ? 0.005 * i * i
                      : i < 600 ? 50.0 + (i - 100)
                      : i < 700 ? 550.0
                                : i - 150;
  return per_row * rows;
}

template <typename Counter>
std::vector<CounterValue> counted(double per_row, const Counter& counter) {
  std::vector<CounterValue> values;
  for (int i = 0; i < 900; ++i)
    values.push_back({std::int64_t{i} * 20'000'000, counter(i, turned(i, per_row))});
  return values;
}

double modulo(double value, double period) { return value - period * std::floor(value / period); }

// Any period is found from the jumps alone, and undone: the turn is that without a counter.
TEST(CounterPeriod, AnyPeriodIsFoundAndUndone) {
  for (const double period : {900.0, 1000.0, 720.0, 3600.0, 777.0}) {
    const double per_row = period / 80.0;
    const auto values =
        counted(per_row, [&](int, double t) { return modulo(std::floor(t) + 500.0, period); });
    const auto found = counter_period(values, kBits, 90.0);
    ASSERT_TRUE(found) << period;
    EXPECT_NEAR(*found, period, period == 777.0 ? 4.0 : 0.0);
    const auto continued = without_wraps(values, period);
    EXPECT_NEAR(continued.back() - continued.front(), std::floor(turned(899, per_row)), 1e-6);
  }
}

// One jump is enough for a period that counters have.
TEST(CounterPeriod, KnownPeriodsNeedOneJump) {
  for (const double period : kBits) {
    const auto values = counted(period / 1000.0, [&](int, double t) {
      return modulo(std::floor(t) + 0.8 * period, period);
    });
    EXPECT_EQ(counter_period(values, kBits, 90.0), period);
  }
}

// Angles within one turn, ten rows a turn, with noise that flickers over the start while standing.
TEST(CounterPeriod, AnglesWithinOneTurn) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  Random random(3, "angles");
  for (const double lowest : {0.0, -std::numbers::pi}) {
    const auto values = counted(0.6, [&](int, double t) {
      return lowest + modulo(t + random.normal(0.0, 0.001) - lowest, kTurn);
    });
    ASSERT_EQ(counter_period(values, std::array{kTurn}, 0.0), kTurn);
    const auto continued = without_wraps(values, kTurn);
    EXPECT_NEAR(continued.back() - continued.front(), turned(899, 0.6), 0.01);
  }
}

// A count that a controller sets to zero, zeros amid a count, a tick that flickers and a count that
// goes on have no period.
TEST(CounterPeriod, OtherCountsHaveNone) {
  const auto none = [](const auto& counter) {
    const auto period = counter_period(counted(13.0, counter), kBits, 90.0);
    EXPECT_FALSE(period) << *period;
  };
  none([](int, double t) { return std::floor(t); });
  none([](int i, double t) { return std::floor(i >= 500 ? t - turned(500, 13.0) : t); });
  none([](int i, double t) {
    return std::floor(i >= 800 ? t - turned(800, 13.0) : i >= 350 ? t - turned(350, 13.0) : t);
  });
  none([](int i, double t) { return i % 200 > 195 ? 0.0 : std::floor(t); });
  none([](int i, double) { return static_cast<double>(i % 3 == 0); });
}

}  // namespace
}  // namespace roadbook
