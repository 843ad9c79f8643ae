#include "exchange/export/planner/crosswalk.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "exchange/export/planner/plan_polygon.hpp"

namespace roadbook {
namespace {

constexpr double kFarLane_m = 15.0;
constexpr double kLeastOverlap_m2 = 1e-3;

std::optional<Eigen::Vector2d> direction_of_nearest(const Eigen::Vector3d& place,
                                                    const LaneletNetwork& network) {
  double least = kFarLane_m;
  std::optional<Eigen::Vector2d> direction;
  for (const Lanelet& lanelet : network.lanelets) {
    const LaneBounds& b = lanelet.bounds;
    for (std::size_t i = 1; i < b.left.size(); ++i) {
      const Eigen::Vector3d centre = 0.5 * (b.left[i] + b.right[i]);
      const double distance = (centre - place).norm();
      if (distance >= least) continue;
      least = distance;
      const Eigen::Vector3d before = 0.5 * (b.left[i - 1] + b.right[i - 1]);
      direction = (centre - before).head<2>().normalized();
    }
  }
  return direction;
}

Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

// The rectangle around an outline, two sides of it along `direction`.
std::vector<Eigen::Vector3d> rectangle_around(const std::vector<Eigen::Vector3d>& outline,
                                              const Eigen::Vector2d& direction) {
  const Eigen::Vector2d across(-direction.y(), direction.x());
  Eigen::Vector2d low(INFINITY, INFINITY);
  Eigen::Vector2d high = -low;
  for (const Eigen::Vector3d& p : outline) {
    const Eigen::Vector2d q(direction.dot(p.head<2>()), across.dot(p.head<2>()));
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  const double height = middle_of(outline).z();
  std::vector<Eigen::Vector3d> ring;
  for (const auto& [u, v] : {std::pair{low.x(), low.y()},
                             {high.x(), low.y()},
                             {high.x(), high.y()},
                             {low.x(), high.y()}}) {
    const Eigen::Vector2d p = u * direction + v * across;
    ring.emplace_back(p.x(), p.y(), height);
  }
  return ring;
}

// Whether a lanelet comes into the box around an outline, on the same floor.
bool is_near(const LaneBounds& bounds, const std::vector<Eigen::Vector3d>& outline) {
  constexpr double kWidestLane_m = 10.0;
  constexpr double kFloor_m = 1.5;
  Eigen::Vector3d low = outline.front();
  Eigen::Vector3d high = outline.front();
  for (const Eigen::Vector3d& p : outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector3d margin(kWidestLane_m, kWidestLane_m, kFloor_m);
  return std::any_of(bounds.left.begin(), bounds.left.end(), [&](const Eigen::Vector3d& p) {
    return (p - low + margin).minCoeff() >= 0.0 && (high + margin - p).minCoeff() >= 0.0;
  });
}

// Empty where the outline encloses no ground or crosses itself.
std::optional<Crosswalk> crosswalk_of(const PlannerCrossing& crossing,
                                      const LaneletNetwork& network) {
  if (!encloses_ground(crossing.corners)) return std::nullopt;
  const PlanGeometry area = polygon_of(crossing.corners);
  Crosswalk walk;
  walk.label = crossing.id;
  walk.outline = crossing.corners;
  walk.rectangle = crossing.corners.size() == 4;
  const auto lane = direction_of_nearest(middle_of(walk.outline), network);
  auto ring = walk.rectangle ? walk.outline
                             : rectangle_around(walk.outline, lane.value_or(Eigen::Vector2d(1, 0)));
  // Sides 0-1 and 2-3 become the bounds; turned by one where the other two lie across the lane.
  const auto side = [&](std::size_t i) { return Eigen::Vector3d(ring[(i + 1) % 4] - ring[i]); };
  const auto along = [&](std::size_t i) {
    return lane ? std::abs(lane->dot(side(i).head<2>().normalized())) : -side(i).norm();
  };
  if (along(1) < along(0)) std::rotate(ring.begin(), ring.begin() + 1, ring.end());
  // Counter-clockwise, the side from corner 0 to corner 1 has the other one to its left.
  const Eigen::Vector3d a = side(0);
  const Eigen::Vector3d b = ring[3] - ring[0];
  const bool counter_clockwise = a.x() * b.y() - a.y() * b.x() > 0.0;
  walk.right = {ring[0], ring[1]};
  walk.left = {ring[3], ring[2]};
  if (!counter_clockwise) std::swap(walk.left, walk.right);
  for (std::size_t i = 0; i < network.lanelets.size(); ++i) {
    if (!is_near(network.lanelets[i].bounds, walk.outline)) continue;
    const PlanGeometry lanelet = polygon_of(network.lanelets[i].bounds);
    if (!lanelet || lanelet->Intersects(area.get()) != TRUE) continue;
    if (ground_of(PlanGeometry(lanelet->Intersection(area.get()))) > kLeastOverlap_m2)
      walk.crossed.push_back(i);
  }
  return walk;
}

}  // namespace

std::vector<Crosswalk> crosswalks_of(const PlannerMap& map,
                                     const LaneletNetwork& network,
                                     bool any_shape,
                                     ExportNotes& notes) {
  std::vector<Crosswalk> walks;
  std::size_t other_shape = 0;
  for (const PlannerCrossing& crossing : map.crossings()) {
    auto walk = crosswalk_of(crossing, network);
    if (!walk) continue;
    other_shape += walk->rectangle || any_shape ? 0 : 1;
    walks.push_back(std::move(*walk));
  }
  add_note(notes, "crossings", map.crossings().size() - walks.size(),
           "their outline encloses no ground or crosses itself");
  add_note(notes, "outlines of crossings", other_shape,
           "a crosswalk has two bounds; the rectangle around the outline is written");
  return walks;
}

}  // namespace roadbook
