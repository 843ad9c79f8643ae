#include "semantics/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace roadbook {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

double cross_product(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// What of a polygon lies to the left of the line through a and b (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Polygon kept;
  const auto side = [&](const Eigen::Vector2d& p) { return cross_product(b - a, p - a); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double at_p = side(p);
    const double at_q = side(q);
    if (at_p >= 0.0) kept.push_back(p);
    if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0))
      kept.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return kept;
}

double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross_product(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

}  // namespace

std::array<Eigen::Vector2d, 4> OrientedBox::corners() const {
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d left(-along.y(), along.x());
  const Eigen::Vector2d l = 0.5 * length_m * along;
  const Eigen::Vector2d w = 0.5 * width_m * left;
  return {centre + l - w, centre + l + w, centre - l + w, centre - l - w};
}

bool OrientedBox::contains(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d d = p - centre;
  return std::abs(d.dot(along)) <= 0.5 * length_m &&
         std::abs(cross_product(along, d)) <= 0.5 * width_m;
}

double intersection_over_union(const OrientedBox& a, const OrientedBox& b) {
  const double reach =
      0.5 * (std::hypot(a.length_m, a.width_m) + std::hypot(b.length_m, b.width_m));
  if ((a.centre - b.centre).norm() >= reach) return 0.0;
  const auto corners_a = a.corners();
  const auto corners_b = b.corners();
  Polygon common(corners_a.begin(), corners_a.end());
  for (std::size_t i = 0; i < 4 && common.size() > 2; ++i)
    common = clipped(common, corners_b[i], corners_b[(i + 1) % 4]);
  if (common.size() < 3) return 0.0;
  const double shared = area_of(common);
  return shared / (a.area() + b.area() - shared);
}

OrientedBox box_of_clicks(const Eigen::Vector2d& begin,
                          const Eigen::Vector2d& end,
                          const Eigen::Vector2d& opposite) {
  OrientedBox box;
  const Eigen::Vector2d side = end - begin;
  box.length_m = side.norm();
  box.heading = std::atan2(side.y(), side.x());
  const Eigen::Vector2d along(std::cos(box.heading), std::sin(box.heading));
  const double left = cross_product(along, opposite - begin);
  box.width_m = std::abs(left);
  box.centre = begin + 0.5 * side + 0.5 * left * Eigen::Vector2d(-along.y(), along.x());
  return box;
}

std::vector<std::size_t> non_maximum_suppression(std::span<const OrientedBox> boxes,
                                                 std::span<const double> scores,
                                                 double max_overlap,
                                                 std::size_t most) {
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
  std::vector<std::size_t> kept;
  for (const std::size_t i : order) {
    if (kept.size() >= most) break;
    if (std::none_of(kept.begin(), kept.end(), [&](std::size_t k) {
          return intersection_over_union(boxes[i], boxes[k]) > max_overlap;
        }))
      kept.push_back(i);
  }
  return kept;
}

std::vector<int> match_boxes(std::span<const OrientedBox> found,
                             std::span<const OrientedBox> truth,
                             double min_overlap) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t f = 0; f < found.size(); ++f)
    for (std::size_t t = 0; t < truth.size(); ++t)
      if (const double overlap = intersection_over_union(found[f], truth[t]);
          overlap >= min_overlap)
        pairs.emplace_back(-overlap, f, t);
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> match(found.size(), -1);
  std::vector<bool> taken(truth.size(), false);
  for (const auto& [overlap, f, t] : pairs)
    if (match[f] < 0 && !taken[t]) {
      match[f] = static_cast<int>(t);
      taken[t] = true;
    }
  return match;
}

}  // namespace roadbook
