#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mapping/occupancy/place_patches.hpp"
#include "mapping/occupancy/scans.hpp"
#include "sensors/range/range_mixture.hpp"

namespace roadbook {

// One grid of the same scans by each rule that is compared.

enum class GridRule {
  kNaive,    ///< the table of document 001
  kHandSet,  ///< probabilities of 0.55 at the end and 0.49 before it (Cartographer's defaults)
  kDerived,  ///< the inverse of the fitted forward model, every reading for itself
  kTempered  ///< the same, weighted by the dependence of the readings
};
[[nodiscard]] const char* to_text(GridRule rule);
[[nodiscard]] const std::vector<GridRule>& all_grid_rules();

struct RuledGrid {
  OccupancyGrid grid;
  double prior_log_odds = 0.0;
  double temper = 1.0;
  RangeMixture mixture;
};

struct RuleOptions {
  double cell_m = 0.1;
  double max_m = 10.0;
  double sigma_m = 0.02;
  double cone_rad = 0.0;
};

/// The grid of all scans by one rule. The beam model is fitted to the same scans; for wide beams
/// `given` replaces the fit, because expected distances of a map of rays do not suit them.
[[nodiscard]] RuledGrid grid_by_rule(const std::vector<RangeScan>& scans,
                                     GridRule rule,
                                     const RuleOptions& options,
                                     const RangeMixture* given = nullptr);

}  // namespace roadbook
