#include "semantics/overhead/overhead_options.hpp"

#include <cmath>

#include "base/require_option.hpp"

namespace roadbook {

void OverheadOptions::check() const {
  require_option(resolution_m >= 0.001 && resolution_m <= 1.0, "resolution_m", resolution_m,
                 "0.001 to 1");
  require_option(!max_range_m || (*max_range_m > 0.0 && *max_range_m <= 100.0), "max_range_m",
                 max_range_m.value_or(0.0), "0 to 100");
  require_option(min_depression_rad >= 0.0 && min_depression_rad < 1.5, "min_depression_rad",
                 min_depression_rad, "0 to 1.5");
  require_option(std::isfinite(border_px) && border_px >= 0.0, "border_px", border_px,
                 "at least 0");
  require_option(memory_mb >= 64, "memory_mb", memory_mb, "at least 64");
  require_option(num_threads >= 0, "num_threads", num_threads, "at least 0");
  gains.check();
  ground.check();
}

}  // namespace roadbook
