#include "apps/report/simulation_section.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/report/html.hpp"
#include "apps/report/svg_plot.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

constexpr double kPlotSide = 240.0, kBesidePlot = 56.0, kUnderPlot = 34.0, kPlotEdge = 8.0;

std::string three_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

// Limits of both axes, which are equal: the diagonal then means the same distribution.
std::pair<double, double> limits_of(const StreamComparison& c) {
  double low = 0.0, high = 0.0;
  bool first = true;
  const auto widen = [&](const SampleDifference& s) {
    for (const auto& [recorded, simulated] : s.quantiles)
      for (const double v : {recorded, simulated}) {
        low = first ? v : std::min(low, v);
        high = first ? v : std::max(high, v);
        first = false;
      }
  };
  widen(c.stated);
  if (c.extended) widen(*c.extended);
  const double margin = 0.05 * std::max(high - low, 1e-12);
  return {low - margin, high + margin};
}

std::string quantile_plot(const StreamComparison& c) {
  const auto [low, high] = limits_of(c);
  const double range = high - low;
  const auto x = [&, first = low](double v) {
    return fixed(kBesidePlot + (v - first) / range * (kPlotSide - kBesidePlot - kPlotEdge), 1);
  };
  const auto y = [&, first = low](double v) {
    return fixed(
        kPlotSide - kUnderPlot - (v - first) / range * (kPlotSide - kUnderPlot - kPlotEdge), 1);
  };
  std::string body;
  for (const double tick : round_ticks(low, high, 4)) {
    body += "<path class=\"grid\" d=\"M" + x(tick) + " " + y(low) + "V" + y(high) + "M" + x(low) +
            " " + y(tick) + "H" + x(high) + "\"/><text x=\"" + x(tick) + "\" y=\"" +
            fixed(kPlotSide - kUnderPlot + 14.0, 1) + "\" text-anchor=\"middle\">" +
            three_digits(tick) + "</text><text x=\"" + fixed(kBesidePlot - 5.0, 1) + "\" y=\"" +
            y(tick) + "\" text-anchor=\"end\" dominant-baseline=\"middle\">" + three_digits(tick) +
            "</text>";
  }
  body += "<path class=\"truth\" d=\"M" + x(low) + " " + y(low) + "L" + x(high) + " " + y(high) +
          "\"/>";
  const auto curve = [&](const SampleDifference& s, const char* css_class) {
    std::string path;
    for (const auto& [recorded, simulated] : s.quantiles)
      path += (path.empty() ? "M" : "L") + x(recorded) + " " + y(simulated);
    body += std::string("<path class=\"track ") + css_class + "\" d=\"" + path + "\"/>";
  };
  curve(c.stated, "s1");
  if (c.extended) curve(*c.extended, "s0");
  body += "<text x=\"" + fixed(0.5 * (kBesidePlot + kPlotSide), 1) + "\" y=\"" +
          fixed(kPlotSide - 4.0, 1) + "\" text-anchor=\"middle\">recorded [" + escaped(c.unit) +
          "]</text>";
  const std::string name = c.stream + " " + c.channel;
  return "<figure><svg viewBox=\"0 0 " + fixed(kPlotSide, 0) + " " + fixed(kPlotSide, 0) +
         "\" role=\"img\"><title>" + escaped(name) + "</title>" + body + "</svg><figcaption>" +
         escaped(name) + "</figcaption></figure>\n";
}

std::string cells(double mean, double sigma) {
  return "<td>" + three_digits(mean) + " &plusmn; " + three_digits(sigma) + "</td>";
}

}  // namespace

std::string simulation_section(const std::vector<StreamComparison>& comparisons) {
  if (comparisons.empty()) return "";
  std::string rows, plots;
  for (const StreamComparison& c : comparisons) {
    rows += "<tr><td>" + escaped(c.stream + " " + c.channel) + " [" + escaped(c.unit) + "]</td>" +
            cells(c.recorded.mean, c.recorded.sigma) +
            cells(c.stated.second.mean, c.stated.second.sigma) + "<td>" +
            fixed(c.stated.distance, 2) + "</td>";
    rows += c.extended ? cells(c.extended->second.mean, c.extended->second.sigma) + "<td>" +
                             fixed(c.extended->distance, 2) + "</td>"
                       : "<td>-</td><td>-</td>";
    rows += "</tr>";
    plots += quantile_plot(c);
  }
  return "<section><h2>What the simulation gets wrong</h2>\n<p>The drive was simulated again along "
         "its reference: as the files state the car, and with the effects found. Values are "
         "readings less what the reference predicts, mean &plusmn; standard deviation. The "
         "distance "
         "of two distributions is 0 where they are the same, and 1 where they have no value in "
         "common.</p>\n<div class=\"scroll\"><table><thead><tr><th></th><th>recorded</th>"
         "<th>as stated</th><th>distance</th><th>with the "
         "effects</th><th>distance</th></tr></thead>"
         "<tbody>" +
         rows +
         "</tbody></table></div>\n<p>Quantiles of the simulated drive (up) against those of the "
         "recorded one: orange as stated, blue with the effects. On the dashed line both agree.</p>"
         "<div class=\"trio\">" +
         plots + "</div></section>\n";
}

}  // namespace roadbook
