#include "apps/report/html.hpp"

#include <algorithm>
#include <cmath>

#include "apps/report/svg_plot.hpp"

namespace roadbook {

std::string html_table(const HtmlRow& head, const std::vector<HtmlRow>& rows) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& cell : head) html += "<th>" + escaped(cell) + "</th>";
  html += "</tr></thead><tbody>";
  for (const HtmlRow& row : rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + escaped(cell) + "</td>";
    html += "</tr>";
  }
  return html + "</tbody></table></div>\n";
}

std::string html_section(const std::string& title, const std::string& body) {
  return "<section><h2>" + escaped(title) + "</h2>\n" + body + "</section>\n";
}

std::string html_figure(const std::string& svg, const std::string& caption) {
  return "<figure>" + svg + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string html_key(const std::string& css_class, const std::string& name) {
  return "<span class=\"key\"><svg viewBox=\"0 0 22 8\"><path class=\"" + css_class +
         "\" d=\"M1 4H21\"/></svg>" + escaped(name) + "</span> ";
}

double sample_quantile(std::vector<double> values, double q) {
  if (values.empty()) return NAN;
  const auto at = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

std::vector<Eigen::Vector2d> driven_positions(const Map& map) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    points.push_back(map.T_map_vehicle(static_cast<int>(i)).translation().head<2>());
  return points;
}

}  // namespace roadbook
