#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

// Makes one continuous angle from cumulative wheel readings (ticks, angles) that start again. A
// counter starts again for two reasons. It wraps: its first value follows its last one, and no tick
// is lost. Or it is reset to zero (a controller was restarted): the turn since the previous row is
// then unknown. A third event is a dropout: a logger writes zeros while it receives nothing. The
// counter then continues as if these zeros did not exist.

/// Event between the previous row and this one.
enum class CounterEvent {
  kNone,
  kWrap,    ///< undone exactly
  kReset,   ///< bridged with the speed before it
  kReturn,  ///< the last reset or jump was a dropout: the counter continues from before it
  kJump,    ///< a step too long for a car that no other event explains; it stays in the angle
};

/// The counter of one wheel. It explains each step as none, a wrap or a reset, in this order. It
/// takes the first explanation that a car can drive and that agrees with the previous speed; if
/// none agrees, the first that a car can drive.
class WheelCounter {
 public:
  /// `ranges_rad`: the ranges at which the counter may wrap, as angles of the wheel.
  WheelCounter(double radius_m, std::vector<double> ranges_rad)
      : radius_m_(radius_m), ranges_rad_(std::move(ranges_rad)) {}
  /// Continuous angle [rad] for a reading `now_rad` taken `dt_s` after the one before.
  double add(double now_rad, double dt_s);
  [[nodiscard]] CounterEvent event() const { return event_; }

 private:
  struct Step {
    CounterEvent event;
    double turn_rad;
  };
  [[nodiscard]] Step explain(double now_rad, double dt_s) const;
  [[nodiscard]] double fastest_rad(double dt_s) const;
  [[nodiscard]] bool goes_on_from_before(double now_rad) const;
  void remember_speed(double turn_rad, double dt_s);

  double radius_m_;
  std::vector<double> ranges_rad_;
  CounterEvent event_ = CounterEvent::kNone;
  bool first_ = true;
  double before_rad_ = 0.0;
  double lowest_rad_ = 0.0;  ///< of all readings
  double highest_rad_ = 0.0;
  double added_rad_ = 0.0;  ///< to readings, since the first
  bool knows_speed_ = false;
  double speed_rad_s_ = 0.0;
  // Of the row before the last reset or jump; time 0: there was none.
  double held_rad_ = 0.0;
  double held_added_rad_ = 0.0;
  double held_s_ = 0.0;
};

/// Counts a wheel's resets and dropouts, for one warning a table.
class CounterReport {
 public:
  void add(CounterEvent event, std::int64_t line);
  /// Empty where there was none.
  [[nodiscard]] std::optional<Problem> problem(const std::string& file,
                                               const std::string& wheel) const;

 private:
  CounterEvent last_ = CounterEvent::kNone;
  std::size_t resets_ = 0;
  std::size_t dropouts_ = 0;
  std::int64_t first_line_ = 0;
};

/// Ranges of tick counters of 16 and 32 bits as angles of the wheel [rad].
[[nodiscard]] std::vector<double> tick_ranges_rad(double ticks_per_turn);

/// Faster than any car that makes maps; a wheel that turned faster is a damaged table.
inline constexpr double kFastestCar_m_s = 70.0;
/// Says whether a wheel that rolled so far between two rows was faster than any car. Rows that
/// follow each other closely are noisy: half a metre is allowed.
[[nodiscard]] bool is_faster_than_cars(double way_m, double dt_s);

}  // namespace roadbook
