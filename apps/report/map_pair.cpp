#include "apps/report/map_pair.hpp"

#include <algorithm>

#include "apps/report/chart.hpp"
#include "apps/report/html.hpp"
#include "apps/report/svg_plot.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

constexpr double kPanelLeft = 44.0;
constexpr double kPanelTop = 28.0;
constexpr double kWidestPanel = 380.0;  // [px] width of a panel
constexpr double kHighest = 420.0;

struct PanelLayout {
  PlanBounds bounds;
  double scale = 1.0;  ///< [px/m]
  double width = 0.0;
  double height = 0.0;
  [[nodiscard]] std::string x(double x_m) const { return fixed(scale * (x_m - bounds.low.x()), 1); }
  [[nodiscard]] std::string y(double y_m) const {
    return fixed(scale * (bounds.high.y() - y_m), 1);
  }
};

PanelLayout layout_of(const std::vector<MapPanel>& panels) {
  PanelLayout layout;
  layout.bounds = panels.front().picture->place;
  for (const MapPanel& panel : panels) {
    layout.bounds.low = layout.bounds.low.cwiseMin(panel.picture->place.low);
    layout.bounds.high = layout.bounds.high.cwiseMax(panel.picture->place.high);
  }
  const Eigen::Vector2d size = layout.bounds.high - layout.bounds.low;
  layout.scale = std::min(kWidestPanel / size.x(), kHighest / size.y());
  layout.width = layout.scale * size.x();
  layout.height = layout.scale * size.y();
  return layout;
}

// The element contains its colours and sizes, because the page's style sheet does not apply to
// pictures on white.
std::string text(const std::string& x,
                 const std::string& y,
                 const char* anchor,
                 const std::string& words) {
  return "<text x=\"" + x + "\" y=\"" + y + "\" text-anchor=\"" + anchor +
         "\" style=\"fill:#222;font-size:12px\">" + escaped(words) + "</text>\n";
}

std::string axes(const PanelLayout& layout) {
  std::string svg = "<rect width=\"" + fixed(layout.width, 1) + "\" height=\"" +
                    fixed(layout.height, 1) + "\" fill=\"none\" stroke=\"#999\"/>\n";
  const std::string bottom = fixed(layout.height, 1);
  for (const double x : round_ticks(layout.bounds.low.x(), layout.bounds.high.x(), 6))
    svg += "<path stroke=\"#999\" d=\"M" + layout.x(x) + " " + bottom + "v4\"/>" +
           text(layout.x(x), fixed(layout.height + 17.0, 1), "middle", fixed(x, 0));
  for (const double y : round_ticks(layout.bounds.low.y(), layout.bounds.high.y(), 6))
    svg +=
        "<path stroke=\"#999\" d=\"M0 " + layout.y(y) + "h-4\"/>" +
        text("-7", fixed(layout.scale * (layout.bounds.high.y() - y) + 4.0, 1), "end", fixed(y, 0));
  return svg + text(fixed(0.5 * layout.width, 1), fixed(layout.height + 32.0, 1), "middle",
                    "x [m], y upwards [m]");
}

std::string colour_scale(const MapPanel& panel, const PanelLayout& layout) {
  constexpr int kSteps = 48;
  const double width = std::min(layout.width, 240.0);
  const double top = layout.height + 42.0;
  std::string svg;
  for (int i = 0; i < kSteps; ++i)
    svg += "<rect x=\"" + fixed(width * i / kSteps, 1) + "\" y=\"" + fixed(top, 1) + "\" width=\"" +
           fixed(width / kSteps + 0.4, 1) + "\" height=\"10\" fill=\"" +
           ramp_colour(i, 0.0, kSteps - 1.0) + "\"/>";
  for (int i = 0; i <= 4; ++i) {
    const double value = panel.dark_value + 0.25 * i * (panel.yellow_value - panel.dark_value);
    svg += text(fixed(0.25 * i * width, 1), fixed(top + 24.0, 1), i == 0 ? "start" : "middle",
                fixed(value, 1) + (i == 4 ? " " + panel.unit : ""));
  }
  return svg + "\n";
}

std::string panel_svg(const MapPanel& panel,
                      const PanelLayout& layout,
                      const std::vector<std::vector<Eigen::Vector2d>>& lanes) {
  const PlanBounds& place = panel.picture->place;
  std::string svg = text("0", "-9", "start", panel.title) + "<image x=\"" +
                    layout.x(place.low.x()) + "\" y=\"" + layout.y(place.high.y()) + "\" width=\"" +
                    fixed(layout.scale * (place.high.x() - place.low.x()), 1) + "\" height=\"" +
                    fixed(layout.scale * (place.high.y() - place.low.y()), 1) +
                    "\" preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" href=\"" +
                    data_uri("image/png", panel.picture->png) + "\"/>\n";
  for (const auto& lane : lanes) {
    // A white line with a black border is visible on dark and on yellow.
    std::string points;
    for (const Eigen::Vector2d& p : lane) points += layout.x(p.x()) + "," + layout.y(p.y()) + " ";
    for (const char* stroke : {"stroke:#000;stroke-width:2.2;opacity:.35",
                               "stroke:#fff;stroke-width:1.2;stroke-dasharray:5 4"})
      svg +=
          "<polyline style=\"fill:none;" + std::string(stroke) + "\" points=\"" + points + "\"/>\n";
  }
  return svg + axes(layout) + colour_scale(panel, layout);
}

}  // namespace

std::string map_pair_svg(const std::vector<MapPanel>& panels,
                         const std::vector<std::vector<Eigen::Vector2d>>& lanes) {
  const PanelLayout layout = layout_of(panels);
  const double pitch = std::max(layout.width, 280.0) + kPanelLeft + 16.0;
  const double width = pitch * static_cast<double>(panels.size());
  const double height = kPanelTop + layout.height + 92.0;
  std::string title;
  std::string body;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    title += (title.empty() ? "" : " beside ") + panels[i].title;
    body += "<g transform=\"translate(" + fixed(kPanelLeft + pitch * static_cast<double>(i), 1) +
            " " + fixed(kPanelTop, 1) + ")\">\n" + panel_svg(panels[i], layout, lanes) + "</g>\n";
  }
  body += "<path d=\"M" + fixed(kPanelLeft, 1) + " " + fixed(height - 12.0, 1) +
          "h26\" style=\"fill:none;stroke:#222;stroke-width:1.2;stroke-dasharray:5 4\"/>" +
          text(fixed(kPanelLeft + 34.0, 1), fixed(height - 8.0, 1), "start",
               "middle of the lanes; white: nothing known");
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + fixed(width, 0) + "\" height=\"" +
         fixed(height, 0) + "\" viewBox=\"0 0 " + fixed(width, 0) + " " + fixed(height, 0) +
         "\" font-family=\"sans-serif\" font-size=\"12\" role=\"img\">\n<title>" + escaped(title) +
         "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" + body + "</svg>\n";
}

}  // namespace roadbook
