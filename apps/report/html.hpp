#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "apps/report/report_data.hpp"

namespace roadbook {

// Parts of the report's page.

using HtmlRow = std::vector<std::string>;

[[nodiscard]] std::string html_table(const HtmlRow& head, const std::vector<HtmlRow>& rows);
[[nodiscard]] std::string html_section(const std::string& title, const std::string& body);
/// `caption` is HTML.
[[nodiscard]] std::string html_figure(const std::string& svg, const std::string& caption);
/// Draws a stroke of the style sheet's class with its name, for legends.
[[nodiscard]] std::string html_key(const std::string& css_class, const std::string& name);

/// Returns NaN if there are no values.
[[nodiscard]] double sample_quantile(std::vector<double> values, double q);
[[nodiscard]] std::vector<Eigen::Vector2d> driven_positions(const Map& map);

/// Shows reprojection errors, observations and views, and errors against the truth.
[[nodiscard]] std::string quality_section(const ReportData& data);
[[nodiscard]] std::string loops_section(const ReportData& data);
/// Shows the network in its stages, and its lanes. Empty if `roads` was not run.
[[nodiscard]] std::string network_section(const ReportData& data);

}  // namespace roadbook
