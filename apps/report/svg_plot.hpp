#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "workflows/report/plan_bounds.hpp"

namespace roadbook {

// Plots as inline SVG. Colours are CSS classes of the page's style sheet (apps/report/page.cpp), so
// that one picture is suitable for a light and a dark page.

/// Returns about `count` round numbers or fewer inside [low, high], at steps of 1, 2 or 5 times a
/// power of ten.
[[nodiscard]] std::vector<double> round_ticks(double low, double high, int count);

/// A view from above: x to the right, y up, equal scale on both axes, ticks in metres.
class PlanPlot {
 public:
  explicit PlanPlot(const PlanBounds& bounds,
                    double width_px = 860.0,
                    double max_height_px = 640.0);

  /// Draws a picture, north up, over the given rectangle. Later shapes cover it.
  void image(const std::string& data_uri, const PlanBounds& place);
  /// Draws a line. Leaves out points closer than a third of a pixel to the last drawn one.
  void polyline(const std::vector<Eigen::Vector2d>& points, const std::string& css_class);
  /// Draws separate segments in one element.
  void segments(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& pairs,
                const std::string& css_class);
  void dots(const std::vector<Eigen::Vector2d>& points,
            double radius_px,
            const std::string& css_class);
  void label(const Eigen::Vector2d& point, const std::string& text, const std::string& css_class);

  /// Returns the complete element. Screen readers read the `title`.
  [[nodiscard]] std::string svg(const std::string& title) const;

 private:
  [[nodiscard]] Eigen::Vector2d to_px(const Eigen::Vector2d& p) const;

  PlanBounds bounds_;
  double scale_ = 1.0;  ///< [px/m]
  double width_px_ = 0.0;
  double height_px_ = 0.0;
  std::string body_;
};

/// Draws bars over equal bins of x. The names of axes include their units.
[[nodiscard]] std::string histogram_svg(const std::vector<double>& values,
                                        double low,
                                        double high,
                                        int bins,
                                        const std::string& x_name,
                                        const std::string& y_name);

/// Draws y over x as a line. The y axis starts at 0.
[[nodiscard]] std::string line_chart_svg(const std::vector<Eigen::Vector2d>& points,
                                         const std::string& x_name,
                                         const std::string& y_name);

struct NamedBar {
  std::string name;
  double value = 0.0;
  std::string text;  ///< next to the bar
};
/// Draws horizontal bars with their names.
[[nodiscard]] std::string bars_svg(const std::vector<NamedBar>& bars);

}  // namespace roadbook
