#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace roadbook {

/// Quantity that a column of a log measures; each has its own units.
enum class Quantity { kTime, kLength, kAngle, kSpeed, kTurnRate, kWheel, kNumber };

/// Kind of wheel reading that a unit implies.
enum class WheelUnit { kAngle, kAnglePerRow, kTicks, kLength, kLengthPerRow, kTurnRate, kSpeed };

struct Unit {
  double to_si = 1.0;                   ///< 1 for ticks, which ticks_per_turn converts to angles
  WheelUnit wheel = WheelUnit::kAngle;  ///< for kWheel
  bool per_row = false;                 ///< increment since the previous row
  bool ticks = false;
};

/// The unit called `name`; no value if `quantity` has no such unit.
[[nodiscard]] std::optional<Unit> find_unit(Quantity quantity, std::string_view name);
/// For messages: "one of s, ms, us, ns".
[[nodiscard]] std::string units_of(Quantity quantity);

}  // namespace roadbook
