#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace roadbook {

// Self-contained charts: each is an SVG file with its own colours, on white, for documents and
// reports.

/// A curve: points with an optional half width (same length, or empty), which is drawn as a band.
struct ChartSeries {
  std::string name;
  std::vector<Eigen::Vector2d> points;
  std::vector<double> half_width;
  bool dashed = false;
};

/// Returns the points (i, values[i]).
[[nodiscard]] ChartSeries series_by_number(const std::string& name,
                                           const std::vector<double>& values,
                                           bool dashed);

struct ChartAxes {
  std::string title;
  std::string x_name;
  std::string y_name;
  double y_min = 0.0;
  double y_max = 0.0;  ///< not above y_min: chosen from the points
  int width_px = 760;
  int height_px = 400;
};

/// Draws curves over x with a legend. The frame clips values above y_max.
[[nodiscard]] std::string chart_svg(const ChartAxes& axes, const std::vector<ChartSeries>& series);

/// Returns the colour "#rrggbb" of a value between `low` and `high`, from dark violet over green to
/// yellow. The colours are close to "viridis", which keeps its order for colour-blind readers and
/// in grey.
[[nodiscard]] std::string ramp_colour(double value, double low, double high);

}  // namespace roadbook
