#include "roadnet/network_options.hpp"

#include <cmath>

#include "base/require_option.hpp"

namespace roadbook {

void RoadNetworkOptions::check() const {
  const auto finite_positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  require_option(std::isfinite(reach_m) && reach_m >= 0.0, "reach_m", reach_m, "0 or more");
  require_option(finite_positive(min_reach_m), "min_reach_m", min_reach_m, "more than 0");
  require_option(std::isfinite(max_reach_m) && max_reach_m >= min_reach_m, "max_reach_m",
                 max_reach_m, "min_reach_m or more");
  require_option(finite_positive(vertical_limit_m), "vertical_limit_m", vertical_limit_m,
                 "more than 0");
  require_option(min_coverage >= 0.0 && min_coverage <= 1.0, "min_coverage", min_coverage,
                 "0 to 1");
  require_option(std::isfinite(max_gap_m) && max_gap_m >= 0.0, "max_gap_m", max_gap_m, "0 or more");
  require_option(std::isfinite(attraction_m) && attraction_m >= 0.0, "attraction_m", attraction_m,
                 "0 or more");
  require_option(min_passes >= 1, "min_passes", min_passes, "1 or more");
}

RoadNetworkOptions RoadNetworkOptions::for_gps() {
  RoadNetworkOptions options;
  options.reach_m = 16.0;
  options.min_passes = 5;
  options.attraction_m = 12.0;
  options.max_gap_m = 100.0;
  options.min_coverage = 0.95;
  return options;
}

}  // namespace roadbook
