#pragma once

#include <string>

#include "workflows/report/report_data.hpp"

namespace roadbook {

/// Shows the network in its stages, and its lanes. Empty if `roads` was not run.
[[nodiscard]] std::string network_section(const ReportData& data);

}  // namespace roadbook
