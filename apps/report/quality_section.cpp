#include "apps/report/quality_section.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <regex>

#include "apps/report/html.hpp"
#include "apps/report/svg_plot.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

std::vector<double> as_doubles(const auto& values) {
  return std::vector<double>(values.begin(), values.end());
}

// Replaces numbers, "100 corners agree" -> "N corners agree", so that each kind of reason has one
// row.
std::string kind_of(const std::string& reason) {
  static const std::regex number("[0-9]+(\\.[0-9]+)?");
  return std::regex_replace(reason, number, "N");
}

}  // namespace

std::string loops_section(const ReportData& data) {
  if (data.map.loops.empty())
    return html_section("Loops", "<p>No place was seen twice, or none was recognised.</p>");
  std::map<std::pair<bool, std::string>, std::pair<int, int>> reasons;
  for (const LoopEdge& loop : data.map.loops) {
    auto& [count, inliers] = reasons[{!loop.accepted, kind_of(loop.reason)}];
    ++count;
    inliers += loop.inliers;
  }
  std::vector<HtmlRow> rows;
  for (const auto& [reason, sums] : reasons)
    rows.push_back({reason.first ? "rejected" : "accepted", reason.second,
                    std::to_string(sums.first), fixed(1.0 * sums.second / sums.first, 0)});
  return html_section("Loops", html_table({"", "reason", "loops", "mean inliers"}, rows));
}

std::string quality_section(const ReportData& data) {
  const auto residuals = as_doubles(data.quality.residuals_px);
  const double reach = std::max(1.0, std::ceil(sample_quantile(residuals, 0.99)));
  std::string html = "<div class=\"pair\">";
  html += html_figure(
      histogram_svg(residuals, 0.0, reach, 40, "reprojection error [px]", "observations"),
      "Distance between seen and predicted pixel, full-size image: median " +
          fixed(sample_quantile(residuals, 0.5), 2) + " px, 95 % " +
          fixed(sample_quantile(residuals, 0.95), 2) + " px.");
  std::vector<Eigen::Vector2d> seen;
  for (std::size_t i = 0; i < data.quality.observations_of_keyframe.size(); ++i)
    seen.emplace_back(static_cast<double>(i), data.quality.observations_of_keyframe[i]);
  html += html_figure(line_chart_svg(seen, "keyframe", "observations"),
                      "Landmarks seen in each keyframe, all cameras together.");
  const auto views = as_doubles(data.quality.views_of_landmark);
  const double most = std::max(10.0, std::ceil(sample_quantile(views, 0.99)));
  html += html_figure(histogram_svg(views, 0.0, most, std::min(40, static_cast<int>(most)),
                                    "images that see a landmark", "landmarks"),
                      "Mean " +
                          fixed(views.empty() ? 0.0
                                              : std::accumulate(views.begin(), views.end(), 0.0) /
                                                    static_cast<double>(views.size()),
                                1) +
                          " images a landmark.");
  for (const TruthComparison& truth : data.truth.sessions)
    html += html_figure(
        line_chart_svg(truth.error_along_m, "driven [m]", "error [m]"),
        "Distance from the drive's truth along the drive" +
            (data.map.sessions.size() > 1
                 ? " (" + escaped(data.map.sessions[static_cast<std::size_t>(truth.session)].name) +
                       ")"
                 : std::string()) +
            ".");
  return html_section("Quality", html + "</div>");
}

}  // namespace roadbook
