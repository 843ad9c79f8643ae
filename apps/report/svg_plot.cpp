#include "apps/report/svg_plot.hpp"

#include <algorithm>
#include <cmath>

#include "apps/report/html.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

constexpr double kLeft = 56.0;  // room for the numbers of the y axis [px]
constexpr double kBottom = 42.0;
constexpr double kTop = 10.0;
constexpr double kRight = 14.0;

std::string px(double value) { return fixed(value, 1); }

std::string tick_text(double value) {
  const double size = std::abs(value);
  if (size > 0.0 && size < 0.01) return fixed(value, 4);
  for (int decimals = 0; decimals < 3; ++decimals) {
    const double unit = std::pow(10.0, decimals);
    if (std::abs(value * unit - std::round(value * unit)) < 1e-6) return fixed(value, decimals);
  }
  return fixed(value, 3);
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + px(x) + "\" y=\"" + px(y) + "\" text-anchor=\"" + anchor + "\">" +
         escaped(text) + "</text>";
}

std::string line_at(double x1, double y1, double x2, double y2, const std::string& css_class) {
  return "<line class=\"" + css_class + "\" x1=\"" + px(x1) + "\" y1=\"" + px(y1) + "\" x2=\"" +
         px(x2) + "\" y2=\"" + px(y2) + "\"/>";
}

std::string element(double width,
                    double height,
                    const std::string& title,
                    const std::string& body) {
  return "<svg viewBox=\"0 0 " + px(width) + " " + px(height) +
         "\" role=\"img\" style=\"max-width:" + px(width) + "px\"><title>" + escaped(title) +
         "</title>" + body + "</svg>\n";
}

// Maps data to pixels: x to the right, y up. Draws ticks, a light grid and the names of the axes.
struct Frame {
  double x_low, x_high, y_low, y_high;
  double width, height;  ///< of the inner rectangle [px]

  [[nodiscard]] double x(double value) const {
    return kLeft + (value - x_low) / (x_high - x_low) * width;
  }
  [[nodiscard]] double y(double value) const {
    return kTop + height - (value - y_low) / (y_high - y_low) * height;
  }
  // On a plan, both axes use the wider tick spacing, so that grid cells are square.
  [[nodiscard]] std::string axes(const std::string& x_name,
                                 const std::string& y_name,
                                 bool plan = false) const {
    const int x_count = static_cast<int>(width / 80.0);
    const int y_count =
        plan ? std::max(1, static_cast<int>(height / 80.0)) : static_cast<int>(height / 40.0);
    std::string body;
    for (const double tick : round_ticks(x_low, x_high, x_count)) {
      body += line_at(x(tick), kTop, x(tick), kTop + height, "grid");
      body += text_at(x(tick), kTop + height + 16.0, "middle", tick_text(tick));
    }
    for (const double tick : round_ticks(y_low, y_high, y_count)) {
      body += line_at(kLeft, y(tick), kLeft + width, y(tick), "grid");
      body += text_at(kLeft - 6.0, y(tick) + 4.0, "end", tick_text(tick));
    }
    body += text_at(kLeft + width / 2.0, kTop + height + 35.0, "middle", x_name);
    const double middle = kTop + height / 2.0;
    body += "<g transform=\"rotate(-90 12 " + px(middle) + ")\">" +
            text_at(12.0, middle, "middle", y_name) + "</g>";
    return body;
  }
};

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  std::vector<double> ticks;
  if (!(high > low) || !std::isfinite(high - low)) return ticks;
  const double raw = (high - low) / std::max(count, 1);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= raw * (1.0 - 1e-9)) step = factor * power;
  const double first = std::ceil(low / step - 1e-9);
  const double last = std::floor(high / step + 1e-9);
  for (double i = first; i <= last; ++i) ticks.push_back(i == 0.0 ? 0.0 : i * step);
  return ticks;
}

PlanPlot::PlanPlot(const PlanBounds& bounds, double width_px, double max_height_px)
    : bounds_(bounds) {
  const Eigen::Vector2d size = (bounds.high - bounds.low).cwiseMax(1e-3);
  scale_ =
      std::min((width_px - kLeft - kRight) / size.x(), (max_height_px - kTop - kBottom) / size.y());
  // The plot of a narrow place keeps the width of the page and shows more of the surroundings.
  const double wide = (width_px - kLeft - kRight) / scale_;
  const double extra = (wide - size.x()) / 2.0;
  bounds_.low.x() -= extra;
  bounds_.high.x() += extra;
  width_px_ = wide * scale_;
  height_px_ = size.y() * scale_;
}

Eigen::Vector2d PlanPlot::to_px(const Eigen::Vector2d& p) const {
  return {kLeft + (p.x() - bounds_.low.x()) * scale_,
          kTop + height_px_ - (p.y() - bounds_.low.y()) * scale_};
}

void PlanPlot::image(const std::string& data_uri, const PlanBounds& place) {
  const Eigen::Vector2d corner = to_px({place.low.x(), place.high.y()});
  const Eigen::Vector2d size = (place.high - place.low) * scale_;
  body_ += "<image href=\"" + data_uri + "\" x=\"" + px(corner.x()) + "\" y=\"" + px(corner.y()) +
           "\" width=\"" + px(size.x()) + "\" height=\"" + px(size.y()) +
           "\" preserveAspectRatio=\"none\"/>";
}

void PlanPlot::polyline(const std::vector<Eigen::Vector2d>& points, const std::string& css_class) {
  if (points.empty()) return;
  std::string path;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d p = to_px(points[i]);
    if (i > 0 && i + 1 < points.size() && (p - last).norm() < 1.0 / 3.0) continue;
    path += (i == 0 ? "M" : "L") + px(p.x()) + " " + px(p.y());
    last = p;
  }
  body_ += "<path class=\"" + css_class + "\" d=\"" + path + "\"/>";
}

void PlanPlot::segments(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& pairs,
                        const std::string& css_class) {
  if (pairs.empty()) return;
  std::string path;
  for (const auto& [from, to] : pairs) {
    const Eigen::Vector2d a = to_px(from);
    const Eigen::Vector2d b = to_px(to);
    path += "M" + px(a.x()) + " " + px(a.y()) + "L" + px(b.x()) + " " + px(b.y());
  }
  body_ += "<path class=\"" + css_class + "\" d=\"" + path + "\"/>";
}

void PlanPlot::dots(const std::vector<Eigen::Vector2d>& points,
                    double radius_px,
                    const std::string& css_class) {
  if (points.empty()) return;
  // A line of zero length with round ends is a dot. One element draws all dots.
  std::string path;
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d p = to_px(point);
    path += "M" + px(p.x()) + " " + px(p.y()) + "h0";
  }
  body_ += "<path class=\"dot " + css_class + "\" stroke-width=\"" + px(2.0 * radius_px) +
           "\" d=\"" + path + "\"/>";
}

void PlanPlot::label(const Eigen::Vector2d& point,
                     const std::string& text,
                     const std::string& css_class) {
  const Eigen::Vector2d p = to_px(point);
  body_ +=
      "<g class=\"" + css_class + "\">" + text_at(p.x() + 7.0, p.y() - 7.0, "start", text) + "</g>";
}

std::string PlanPlot::svg(const std::string& title) const {
  const Frame frame{bounds_.low.x(),  bounds_.high.x(), bounds_.low.y(),
                    bounds_.high.y(), width_px_,        height_px_};
  // Clip shapes at the frame, so that they do not cover the numbers. Each plot has its own clip
  // name.
  const std::string id = "c" + std::to_string(std::hash<std::string>{}(title + body_));
  const std::string clip = "<clipPath id=\"" + id + "\"><rect x=\"" + px(kLeft) + "\" y=\"" +
                           px(kTop) + "\" width=\"" + px(width_px_) + "\" height=\"" +
                           px(height_px_) + "\"/></clipPath>";
  return element(width_px_ + kLeft + kRight, height_px_ + kTop + kBottom, title,
                 frame.axes("x [m]", "y [m]", true) + clip + "<g clip-path=\"url(#" + id + ")\">" +
                     body_ + "</g>");
}

std::string histogram_svg(const std::vector<double>& values,
                          double low,
                          double high,
                          int bins,
                          const std::string& x_name,
                          const std::string& y_name) {
  std::vector<std::size_t> counts(static_cast<std::size_t>(bins), 0);
  for (const double value : values) {
    const double place = (value - low) / (high - low) * bins;
    if (place >= 0.0 && place < bins) ++counts[static_cast<std::size_t>(place)];
  }
  const auto most = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
  const Frame frame{low, high, 0.0, std::max(1.0, 1.08 * most), 340.0, 180.0};
  std::string body = frame.axes(x_name, y_name);
  const double step = (high - low) / bins;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double x = frame.x(low + static_cast<double>(i) * step);
    const double top = frame.y(static_cast<double>(counts[i]));
    body += "<rect class=\"bar\" x=\"" + px(x + 0.5) + "\" y=\"" + px(top) + "\" width=\"" +
            px(frame.width / bins - 1.0) + "\" height=\"" + px(frame.y(0.0) - top) + "\"/>";
  }
  return element(frame.width + kLeft + kRight, frame.height + kTop + kBottom, x_name, body);
}

std::string line_chart_svg(const std::vector<Eigen::Vector2d>& points,
                           const std::string& x_name,
                           const std::string& y_name) {
  Frame frame{0.0, 1.0, 0.0, 1e-3, 340.0, 180.0};
  if (!points.empty()) frame.x_low = points.front().x();
  for (const Eigen::Vector2d& p : points) {
    frame.x_low = std::min(frame.x_low, p.x());
    frame.x_high = std::max(frame.x_high, p.x());
    frame.y_high = std::max(frame.y_high, 1.08 * p.y());
  }
  std::string path;
  for (std::size_t i = 0; i < points.size(); ++i)
    path += (i == 0 ? "M" : "L") + px(frame.x(points[i].x())) + " " + px(frame.y(points[i].y()));
  return element(frame.width + kLeft + kRight, frame.height + kTop + kBottom, y_name,
                 frame.axes(x_name, y_name) + "<path class=\"curve\" d=\"" + path + "\"/>");
}

std::string bars_svg(const std::vector<NamedBar>& bars) {
  constexpr double kName = 190.0;
  constexpr double kRow = 24.0;
  constexpr double kLength = 400.0;
  double most = 1e-12;
  for (const NamedBar& bar : bars) most = std::max(most, bar.value);
  std::string body;
  double y = 4.0;
  for (const NamedBar& bar : bars) {
    const double length = std::max(1.0, bar.value / most * kLength);
    body += text_at(kName - 8.0, y + 14.0, "end", bar.name);
    body += "<rect class=\"bar\" x=\"" + px(kName) + "\" y=\"" + px(y) + "\" width=\"" +
            px(length) + "\" height=\"18\" rx=\"2\"/>";
    body += text_at(kName + length + 8.0, y + 14.0, "start", bar.text);
    y += kRow;
  }
  return element(kName + kLength + 200.0, y + 4.0, "bars", body);
}

}  // namespace roadbook
