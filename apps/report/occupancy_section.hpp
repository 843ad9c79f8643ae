#pragma once

#include <string>

#include "workflows/report/report_data.hpp"

namespace roadbook {

/// Scores the occupancy grid against the seven demands of document 001. Figures that need a truth
/// are called unknown without one. Empty for a map without a grid.
[[nodiscard]] std::string occupancy_section(const ReportData& data);

}  // namespace roadbook
