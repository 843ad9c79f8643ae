#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace roadbook {

/// What a column of a log measures; each has its own units.
enum class Quantity { kTime, kLength, kAngle, kSpeed, kTurnRate, kWheel, kNumber };

/// Kinds of wheel reading that a unit stands for.
enum class WheelUnit { kAngle, kTicks, kLength, kLengthPerRow, kTurnRate, kSpeed };

struct Unit {
  double to_si = 1.0;                   ///< of ticks: 1, turned into angles by ticks_per_turn
  WheelUnit wheel = WheelUnit::kAngle;  ///< of `kWheel`
  bool per_row = false;                 ///< an increment since the row before
  bool ticks = false;
};

/// Empty where `name` is no unit of `quantity`.
[[nodiscard]] std::optional<Unit> find_unit(Quantity quantity, std::string_view name);
/// For messages: "one of s, ms, us, ns".
[[nodiscard]] std::string units_of(Quantity quantity);

}  // namespace roadbook
