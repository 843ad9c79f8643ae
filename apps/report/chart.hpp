#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace roadbook {

// Charts that stand alone: an SVG file with its own colours, on white, for documents and reports.

/// One curve: points with an optional half width (same length, or empty) drawn as a band.
struct ChartSeries {
  std::string name;
  std::vector<Eigen::Vector2d> points;
  std::vector<double> half_width;
  bool dashed = false;
};

/// values[i] over i.
[[nodiscard]] ChartSeries series_by_number(const std::string& name,
                                           const std::vector<double>& values,
                                           bool dashed);

struct ChartAxes {
  std::string title;
  std::string x_name;
  std::string y_name;
  double y_min = 0.0;
  double y_max = 0.0;  ///< not above y_min: as the points need
  int width_px = 760;
  int height_px = 400;
};

/// Curves over x with a legend. What lies above y_max is cut off at the frame.
[[nodiscard]] std::string chart_svg(const ChartAxes& axes, const std::vector<ChartSeries>& series);

/// Values between `low` and `high` as colours from dark violet over green to yellow (close to
/// "viridis", which keeps its order for the colour-blind and in grey): "#rrggbb".
[[nodiscard]] std::string ramp_colour(double value, double low, double high);

}  // namespace roadbook
