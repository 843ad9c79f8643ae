#include "exchange/import/outline_shape.hpp"

#include <ogr_geometry.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/geometry/outline.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "semantics/labels/label_check.hpp"

namespace roadbook {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

constexpr double kLeastToleranceM = 1e-3;

double distance_to_outline(const Eigen::Vector2d& p, const Corners& outline) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i)
    least = std::min(least, distance_to_segment(p, outline[i], outline[(i + 1) % outline.size()]));
  return least;
}

std::size_t farthest_from(const Corners& corners, const Eigen::Vector2d& p) {
  std::size_t farthest = 0;
  for (std::size_t i = 1; i < corners.size(); ++i)
    if ((corners[i] - p).norm() > (corners[farthest] - p).norm()) farthest = i;
  return farthest;
}

// Douglas and Peucker 1973, from corner `first` on to `last` round the ring.
void keep_corners(const Corners& c,
                  std::size_t first,
                  std::size_t last,
                  double tolerance_m,
                  std::vector<bool>& kept) {
  kept[first] = kept[last] = true;
  const std::size_t n = c.size();
  double largest = tolerance_m;
  std::size_t at = first;
  for (std::size_t i = (first + 1) % n; i != last; i = (i + 1) % n)
    if (const double d = distance_to_segment(c[i], c[first], c[last]); d > largest) {
      largest = d;
      at = i;
    }
  if (at == first) return;
  keep_corners(c, first, at, tolerance_m, kept);
  keep_corners(c, at, last, tolerance_m, kept);
}

// In the order of the ring, without those that lie on a side between others.
Corners corners_that_turn(const Corners& corners, double tolerance_m) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& c : corners) middle += c / static_cast<double>(corners.size());
  const std::size_t first = farthest_from(corners, middle);
  const std::size_t opposite = farthest_from(corners, corners[first]);
  if (opposite == first) return corners;
  std::vector<bool> kept(corners.size(), false);
  keep_corners(corners, first, opposite, tolerance_m, kept);
  keep_corners(corners, opposite, first, tolerance_m, kept);
  Corners turning;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (kept[i]) turning.push_back(corners[i]);
  return turning;
}

double shortest_side(const Corners& c) {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < c.size(); ++i)
    shortest = std::min(shortest, (c[(i + 1) % c.size()] - c[i]).norm());
  return shortest;
}

double rectangle_tolerance_of(const Corners& corners, double step_m) {
  constexpr double kDrawnM = 0.02;
  constexpr double kShareOfSide = 0.15;
  // Four corners, each off by half a step in both coordinates, change a diagonal's length against
  // the other's by four times half a step's diagonal.
  const double rounded = 2.0 * std::sqrt(2.0) * step_m;
  return std::max(kDrawnM, std::min(rounded, kShareOfSide * shortest_side(corners)));
}

OGRPolygon polygon_of_corners(const Corners& corners) {
  OGRLinearRing ring;
  for (const Eigen::Vector2d& p : corners) ring.addPoint(p.x(), p.y());
  ring.closeRings();
  OGRPolygon polygon;
  polygon.addRing(&ring);
  return polygon;
}

Eigen::AlignedBox2d box_around(const Corners& corners) {
  Eigen::AlignedBox2d around;
  for (const Eigen::Vector2d& c : corners) around.extend(c);
  return around;
}

double area_of_geometry(const OGRGeometry& geometry) {
  if (OGR_GT_IsSurface(geometry.getGeometryType())) return geometry.toSurface()->get_Area();
  double area = 0.0;
  if (OGR_GT_IsSubClassOf(geometry.getGeometryType(), wkbGeometryCollection))
    for (const OGRGeometry* part : *geometry.toGeometryCollection())
      area += area_of_geometry(*part);
  return area;
}

}  // namespace

double rounding_step(const std::vector<double>& values) {
  constexpr double kNoise = 1e-4;  // of a step: what arithmetic in another program adds
  constexpr int kMostDecimals = 9;
  constexpr double kLargestSingle = 1e38;
  if (values.empty()) return 0.0;
  double scale = 1.0;
  for (int decimals = 0; decimals <= kMostDecimals; ++decimals, scale *= 10.0)
    if (std::all_of(values.begin(), values.end(),
                    [&](double v) { return std::abs(v * scale - std::round(v * scale)) < kNoise; }))
      return 1.0 / scale;
  double step = 0.0;
  for (const double v : values) {
    if (!(std::abs(v) < kLargestSingle)) return 0.0;
    const auto single = static_cast<float>(v);
    if (static_cast<double>(single) != v) return 0.0;
    const float next = std::nextafter(single, std::numeric_limits<float>::infinity());
    step = std::max(step, static_cast<double>(next) - v);
  }
  return step;
}

double corner_tolerance(const LabelOutline& outline) {
  return std::max(kLeastToleranceM, std::sqrt(2.0) * outline.step_m);
}

double rectangle_tolerance(const LabelOutline& outline) {
  return rectangle_tolerance_of(outline.corners, outline.step_m);
}

void clean_corners(LabelOutline& outline) {
  Corners& corners = outline.corners;
  const double doubled_m = std::max(kLeastToleranceM, 0.5 * outline.step_m);
  const double closed_m = std::max(kLeastToleranceM, 1.5 * outline.step_m);
  const auto repeats = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (a - b).norm() < doubled_m;
  };
  corners.erase(std::unique(corners.begin(), corners.end(), repeats), corners.end());
  while (corners.size() > 1 && (corners.front() - corners.back()).norm() <
                                   (corners.size() > 4 ? closed_m : kLeastToleranceM))
    corners.pop_back();
  if (corners.size() < 5 || corners.size() > kMostCorners) return;
  if (outline.shape == LabelShape::kPolygon) return;
  const double tolerance_m = std::max(0.02, 1.5 * outline.step_m);
  const Corners four = corners_that_turn(corners, tolerance_m);
  if (four.size() == 4 && is_rectangle(four, rectangle_tolerance_of(four, outline.step_m)))
    corners = four;
}

double outline_distance(const Corners& a, const Corners& b) {
  double largest = a.empty() || b.empty() ? std::numeric_limits<double>::infinity() : 0.0;
  for (const Eigen::Vector2d& p : a) largest = std::max(largest, distance_to_outline(p, b));
  for (const Eigen::Vector2d& p : b) largest = std::max(largest, distance_to_outline(p, a));
  return largest;
}

double intersection_over_union(const Corners& a, const Corners& b) {
  if (a.size() < 3 || b.size() < 3 || !box_around(a).intersects(box_around(b))) return 0.0;
  const GdalScope scope;
  const OGRPolygon one = polygon_of_corners(a);
  const OGRPolygon other = polygon_of_corners(b);
  const std::unique_ptr<OGRGeometry> common(one.Intersection(&other));
  if (!common) return 0.0;
  const double shared = area_of_geometry(*common);
  const double either = one.get_Area() + other.get_Area() - shared;
  return either > 0.0 ? shared / either : 0.0;
}

double twice_signed_area(const Corners& c) {
  double twice = 0.0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Eigen::Vector2d& next = c[(i + 1) % c.size()];
    twice += c[i].x() * next.y() - next.x() * c[i].y();
  }
  return twice;
}

}  // namespace roadbook
