#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "workflows/report/speed_report.hpp"

namespace roadbook {

/// Shows both maps side by side with their legends, profiles of the longest lanes and the ages of
/// all items, as HTML. `lanes` are drawn over the maps.
[[nodiscard]] std::string speed_figures(const SpeedReport& report,
                                        const std::vector<std::vector<Eigen::Vector2d>>& lanes);

}  // namespace roadbook
