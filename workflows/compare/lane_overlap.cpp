#include "workflows/compare/lane_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace roadbook {
namespace {

constexpr double kStepM = 0.1;
constexpr double kCellM = 2.0;

struct Stretch {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

// Straight stretches of at most `longest_m`.
std::vector<Stretch> stretches(const std::vector<Polyline>& lines, double longest_m) {
  std::vector<Stretch> list;
  for (const Polyline& line : lines)
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Eigen::Vector2d way = line[i] - line[i - 1];
      const int parts = std::max(1, static_cast<int>(std::ceil(way.norm() / longest_m)));
      for (int part = 0; part < parts; ++part)
        list.push_back({line[i - 1] + way * (static_cast<double>(part) / parts),
                        line[i - 1] + way * (static_cast<double>(part + 1) / parts)});
    }
  return list;
}

double distance_m(const Eigen::Vector2d& p, const Stretch& stretch) {
  const Eigen::Vector2d way = stretch.to - stretch.from;
  const double square = way.squaredNorm();
  const double at = square > 0.0 ? std::clamp((p - stretch.from).dot(way) / square, 0.0, 1.0) : 0.0;
  return (p - stretch.from - at * way).norm();
}

using Cell = std::pair<std::int64_t, std::int64_t>;

Cell cell_of(const Eigen::Vector2d& p) {
  return {std::llround(std::floor(p.x() / kCellM)), std::llround(std::floor(p.y() / kCellM))};
}

// Stretches by the cells that they come within reach of.
std::map<Cell, std::vector<Stretch>> by_cell(const std::vector<Polyline>& lines, double reach_m) {
  std::map<Cell, std::vector<Stretch>> cells;
  const Eigen::Vector2d reach(reach_m, reach_m);
  for (const Stretch& stretch : stretches(lines, kCellM)) {
    const Cell least = cell_of(stretch.from.cwiseMin(stretch.to) - reach);
    const Cell most = cell_of(stretch.from.cwiseMax(stretch.to) + reach);
    for (std::int64_t x = least.first; x <= most.first; ++x)
      for (std::int64_t y = least.second; y <= most.second; ++y) cells[{x, y}].push_back(stretch);
  }
  return cells;
}

}  // namespace

double total_length_m(const std::vector<Polyline>& lines) {
  double length = 0.0;
  for (const Polyline& line : lines)
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

double share_within(const std::vector<Polyline>& lines,
                    const std::vector<Polyline>& others,
                    double reach_m) {
  const auto cells = by_cell(others, reach_m);
  double all = 0.0;
  double within = 0.0;
  for (const Stretch& stretch : stretches(lines, kStepM)) {
    const double length = (stretch.to - stretch.from).norm();
    const Eigen::Vector2d middle = 0.5 * (stretch.from + stretch.to);
    all += length;
    const auto near = cells.find(cell_of(middle));
    if (near != cells.end() &&
        std::any_of(near->second.begin(), near->second.end(),
                    [&](const Stretch& other) { return distance_m(middle, other) <= reach_m; }))
      within += length;
  }
  return all > 0.0 ? within / all : 0.0;
}

}  // namespace roadbook
