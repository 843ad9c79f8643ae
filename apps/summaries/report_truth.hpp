#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/console.hpp"
#include "workflows/report/report_data.hpp"

namespace roadbook {

/// Prints a line for all sessions together, if they can be compared, and one for each session.
void say_truth(const Console& console, const ReportData& data);

/// Adds `truth`, a list by session, and `truth_together`, null without a common alignment.
void add_truth(const ReportData& data, nlohmann::ordered_json& object);

}  // namespace roadbook
