#include "apps/report/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "apps/report/html.hpp"
#include "apps/report/svg_plot.hpp"
#include "base/colour_ramp.hpp"

namespace roadbook {
namespace {

// The colours of Okabe and Ito. Colour-blind readers can distinguish them.
constexpr std::array<const char*, 8> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#7f7f7f", "#000000"};

std::string svg_number(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", std::abs(x) < 1e-12 ? 0.0 : x);
  return text.data();
}

class ChartFrame {
 public:
  ChartFrame(const ChartAxes& axes, const std::vector<ChartSeries>& series) : axes_(axes) {
    low_ = {1e300, axes.y_min};
    high_ = {-1e300, axes.y_max};
    double top = -1e300;
    for (const ChartSeries& one : series)
      for (const Eigen::Vector2d& p : one.points) {
        low_.x() = std::min(low_.x(), p.x());
        high_.x() = std::max(high_.x(), p.x());
        top = std::max(top, p.y());
      }
    if (!(axes.y_max > axes.y_min)) high_.y() = top + 0.08 * (top - axes.y_min);
    if (!(high_.x() > low_.x())) low_.x() = 0.0, high_.x() = 1.0;
    if (!(high_.y() > low_.y())) high_.y() = low_.y() + 1.0;
  }

  [[nodiscard]] std::string x(double value) const {
    return svg_number(kLeft + (value - low_.x()) / (high_.x() - low_.x()) * (right() - kLeft));
  }
  [[nodiscard]] std::string y(double value) const {
    const double held = std::clamp(value, low_.y(), high_.y());
    return svg_number(bottom() - (held - low_.y()) / (high_.y() - low_.y()) * (bottom() - kTop));
  }

  [[nodiscard]] std::string grid() const {
    std::string svg;
    for (const double tick : round_ticks(low_.x(), high_.x(), 8))
      svg += line(x(tick), svg_number(kTop), x(tick), svg_number(bottom())) +
             text(x(tick), svg_number(bottom() + 16), "middle", svg_number(tick));
    for (const double tick : round_ticks(low_.y(), high_.y(), 6))
      svg +=
          line(svg_number(kLeft), y(tick), svg_number(right()), y(tick)) +
          text(svg_number(kLeft - 6), svg_number(std::stod(y(tick)) + 4), "end", svg_number(tick));
    svg += text(svg_number(0.5 * (kLeft + right())), svg_number(bottom() + 34), "middle",
                axes_.x_name);
    svg += "<text transform=\"translate(14 " + svg_number(0.5 * (kTop + bottom())) +
           ") rotate(-90)\" text-anchor=\"middle\" style=\"fill:#222\">" + escaped(axes_.y_name) +
           "</text>";
    return svg + text(svg_number(kLeft), "16", "start", axes_.title);
  }

  [[nodiscard]] static std::string text(const std::string& x,
                                        const std::string& y,
                                        const char* anchor,
                                        const std::string& words) {
    return "<text style=\"fill:#222\" x=\"" + x + "\" y=\"" + y + "\" text-anchor=\"" + anchor +
           "\">" + escaped(words) + "</text>\n";
  }

 private:
  static constexpr double kLeft = 56.0;
  static constexpr double kTop = 28.0;
  [[nodiscard]] double right() const { return axes_.width_px - 12.0; }
  [[nodiscard]] double bottom() const { return axes_.height_px - 44.0; }
  [[nodiscard]] static std::string line(const std::string& x1,
                                        const std::string& y1,
                                        const std::string& x2,
                                        const std::string& y2) {
    return "<line x1=\"" + x1 + "\" y1=\"" + y1 + "\" x2=\"" + x2 + "\" y2=\"" + y2 +
           "\" stroke=\"#ddd\"/>";
  }

  const ChartAxes& axes_;
  Eigen::Vector2d low_, high_;
};

std::string series_curve(const ChartFrame& frame, const ChartSeries& series, const char* colour) {
  std::string svg;
  if (series.half_width.size() == series.points.size() && !series.points.empty()) {
    svg += "<polygon fill=\"" + std::string(colour) + "\" opacity=\"0.15\" points=\"";
    for (std::size_t i = 0; i < series.points.size(); ++i)
      svg += frame.x(series.points[i].x()) + "," +
             frame.y(series.points[i].y() + series.half_width[i]) + " ";
    for (std::size_t i = series.points.size(); i-- > 0;)
      svg += frame.x(series.points[i].x()) + "," +
             frame.y(series.points[i].y() - series.half_width[i]) + " ";
    svg += "\"/>\n";
  }
  svg += "<polyline fill=\"none\" stroke=\"" + std::string(colour) + "\" stroke-width=\"1.8\"" +
         (series.dashed ? " stroke-dasharray=\"5 4\"" : "") + " points=\"";
  for (const Eigen::Vector2d& p : series.points) svg += frame.x(p.x()) + "," + frame.y(p.y()) + " ";
  return svg + "\"/>\n";
}

}  // namespace

ChartSeries series_by_number(const std::string& name,
                             const std::vector<double>& values,
                             bool dashed) {
  ChartSeries one{name, {}, {}, dashed};
  for (std::size_t i = 0; i < values.size(); ++i)
    one.points.emplace_back(static_cast<double>(i), values[i]);
  return one;
}

std::string chart_svg(const ChartAxes& axes, const std::vector<ChartSeries>& series) {
  const ChartFrame frame(axes, series);
  const int legend_px = 16 * static_cast<int>(series.size()) + 8;
  const std::string width = std::to_string(axes.width_px);
  const std::string height = std::to_string(axes.height_px + legend_px);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" +
                    height + "\" viewBox=\"0 0 " + width + " " + height +
                    "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\" role=\"img\">\n" +
                    "<title>" + escaped(axes.title) + "</title>\n" +
                    "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" + frame.grid();
  for (std::size_t i = 0; i < series.size(); ++i) {
    const char* const colour = kColours[i % kColours.size()];
    svg += series_curve(frame, series[i], colour);
    const double y = axes.height_px + 16.0 * static_cast<double>(i);
    svg += "<line x1=\"60\" x2=\"86\" y1=\"" + svg_number(y) + "\" y2=\"" + svg_number(y) +
           "\" stroke=\"" + colour + (series[i].dashed ? "\" stroke-dasharray=\"5 4" : "") +
           "\" stroke-width=\"3\"/>" +
           ChartFrame::text("94", svg_number(y + 4), "start", series[i].name);
  }
  return svg + "</svg>\n";
}

std::string ramp_colour(double value, double low, double high) {
  const auto rgb = colour_ramp((value - low) / (high - low));
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", unsigned{rgb[0]}, unsigned{rgb[1]},
                unsigned{rgb[2]});
  return text.data();
}

}  // namespace roadbook
