#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace roadbook {

// Plots as inline SVG. Colours are CSS classes of the page's style sheet (apps/report/page.cpp), so
// that one picture serves a light and a dark page.

/// At most about `count` round numbers inside [low, high]: 1, 2 or 5 times a power of ten apart.
[[nodiscard]] std::vector<double> round_ticks(double low, double high, int count);

/// "&", "<", ">" and quotes for use in HTML.
[[nodiscard]] std::string escaped(const std::string& text);

/// A rectangle of the map's plane [m].
struct PlanBounds {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Ones();

  /// Of all the points, with a margin of a twentieth; at least a metre wide.
  static PlanBounds around(const std::vector<Eigen::Vector2d>& points);
};

/// A view from above: x to the right, y up, equal scale on both axes, ticks in metres.
class PlanPlot {
 public:
  explicit PlanPlot(const PlanBounds& bounds,
                    double width_px = 860.0,
                    double max_height_px = 640.0);

  /// Draws a picture, north up, over the given rectangle. Later shapes cover it.
  void image(const std::string& data_uri, const PlanBounds& place);
  /// Points closer than a third of a pixel to the last one drawn are left out.
  void polyline(const std::vector<Eigen::Vector2d>& points, const std::string& css_class);
  /// Separate segments in one element.
  void segments(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& pairs,
                const std::string& css_class);
  void dots(const std::vector<Eigen::Vector2d>& points,
            double radius_px,
            const std::string& css_class);
  void label(const Eigen::Vector2d& point, const std::string& text, const std::string& css_class);

  /// The whole element; `title` is read to those who do not see it.
  [[nodiscard]] std::string svg(const std::string& title) const;

 private:
  [[nodiscard]] Eigen::Vector2d to_px(const Eigen::Vector2d& p) const;

  PlanBounds bounds_;
  double scale_ = 1.0;  ///< [px/m]
  double width_px_ = 0.0;
  double height_px_ = 0.0;
  std::string body_;
};

/// Bars over equal bins of x. Names of axes carry their units.
[[nodiscard]] std::string histogram_svg(const std::vector<double>& values,
                                        double low,
                                        double high,
                                        int bins,
                                        const std::string& x_name,
                                        const std::string& y_name);

/// y over x as a line; y starts at 0.
[[nodiscard]] std::string line_chart_svg(const std::vector<Eigen::Vector2d>& points,
                                         const std::string& x_name,
                                         const std::string& y_name);

struct NamedBar {
  std::string name;
  double value = 0.0;
  std::string text;  ///< next to the bar
};
/// Horizontal bars with their names.
[[nodiscard]] std::string bars_svg(const std::vector<NamedBar>& bars);

}  // namespace roadbook
