#pragma once

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "tests/roadnet/chicago.hpp"

namespace roadbook::test {

/// Draws a network over its reference. Grey: the reference. Blue: parts within `near_m` of the
/// reference. Red: other parts. Dots: intersections. A pixel is `metres_a_pixel` wide.
inline void write_network_svg(const std::string& file,
                              const RoadNetwork& network,
                              const std::vector<Line>& reference,
                              double near_m,
                              double metres_a_pixel) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9);
  Eigen::Vector3d high = -low;
  for (const Lane& lane : network.lanes)
    for (const auto& p : lane.centre) {
      low = low.cwiseMin(p - Eigen::Vector3d::Constant(80.0));
      high = high.cwiseMax(p + Eigen::Vector3d::Constant(80.0));
    }
  const auto at = [&](const Eigen::Vector3d& p) {
    const auto whole = [&](double metres) {
      return std::to_string(std::lround(metres / metres_a_pixel));
    };
    return whole(p.x() - low.x()) + " " + whole(high.y() - p.y());
  };
  std::string streets;
  for (const Line& edge : reference) {
    const bool seen = (edge[0].array() > low.array()).head<2>().all() &&
                      (edge[0].array() < high.array()).head<2>().all();
    if (seen) streets += "M" + at(edge[0]) + "L" + at(edge[1]);
  }
  SpatialHash near(near_m);
  for (const Directed& p : points_of(reference, 5.0)) near.insert(p.point);
  std::string good;
  std::string off;
  std::string dots;
  for (const Lane& lane : network.lanes) {
    const Line line = resample({0, false, lane.centre}, 10.0).points;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const bool on = near.nearest(0.5 * (line[i] + line[i + 1]), near_m) >= 0;
      (on ? good : off) += "M" + at(line[i]) + "L" + at(line[i + 1]);
    }
  }
  for (const auto& crossing : network.intersections) dots += "M" + at(crossing.position) + "h0";
  const Eigen::Vector3d size = (high - low) / metres_a_pixel;
  const std::string box =
      std::to_string(std::lround(size.x())) + " " + std::to_string(std::lround(size.y()));
  const auto path = [](const std::string& d, const char* colour, const char* width) {
    return std::string("<path d=\"") + d + "\" stroke=\"" + colour + "\" stroke-width=\"" + width +
           "\"/>\n";
  };
  std::ofstream(file) << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << box
                      << "\" fill=\"none\" stroke-linecap=\"round\">\n<rect width=\"100%\" "
                         "height=\"100%\" fill=\"#fff\"/>\n"
                      << path(streets, "#c8c8c8", "1.5") << path(good, "#1f4fd8", "3")
                      << path(off, "#d82020", "3") << path(dots, "#0a7a2a", "8") << "</svg>\n";
}

}  // namespace roadbook::test
