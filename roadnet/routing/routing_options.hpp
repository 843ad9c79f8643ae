#pragma once

#include <cstdint>

namespace roadbook {

enum class Gear : std::uint8_t { kForward, kReverse };

/// Costs of a route, and what a vehicle may do on it.
struct RoutingOptions {
  double max_turn_rad = 2.4;  ///< sharper turns from lane to lane are not made in one go
  double turn_cost_m_per_rad = 1.0;
  double gear_change_cost_m = 10.0;
  double reverse_factor = 3.0;      ///< a metre backwards costs this many forwards; 1 or more
  double turn_round_cost_m = 20.0;  ///< at a dead end that vehicles came out of forwards
  double direction_over_m = 3.0;  ///< length of lane over which its direction at an end is measured
  bool allow_reverse = true;

  /// Throws InvalidOption.
  void check() const;
};

}  // namespace roadbook
