#pragma once

#include <string>

#include "workflows/report/report_data.hpp"

namespace roadbook {

/// Shows reprojection errors, observations and views, and errors against the truth.
[[nodiscard]] std::string quality_section(const ReportData& data);
/// Counts the loops by their reasons.
[[nodiscard]] std::string loops_section(const ReportData& data);

}  // namespace roadbook
