#include "roadnet/routing/routing_options.hpp"

#include <cmath>
#include <string>

#include "base/error.hpp"

namespace roadbook {

void RoutingOptions::check() const {
  const auto positive = [](const char* field, double value) {
    if (!(std::isfinite(value) && value >= 0.0))
      throw InvalidOption(field, std::to_string(value), "0 or more");
  };
  positive("max_turn_rad", max_turn_rad);
  positive("turn_cost_m_per_rad", turn_cost_m_per_rad);
  positive("gear_change_cost_m", gear_change_cost_m);
  positive("turn_round_cost_m", turn_round_cost_m);
  positive("direction_over_m", direction_over_m);
  if (!(std::isfinite(reverse_factor) && reverse_factor >= 1.0))
    throw InvalidOption("reverse_factor", std::to_string(reverse_factor), "1 or more");
}

}  // namespace roadbook
