#include "exchange/export/lanelet2/autoware_parking.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "exchange/export/planner/plan_polygon.hpp"

namespace roadbook {
namespace {

constexpr double kLineReach_m = 5.0;     // Autoware's, from a space's line to its lanelet
constexpr double kLineLengths = 5.0;     // Autoware's, that the line is extended by
constexpr double kMargin_m = 0.1;        // of a lot around its spaces
constexpr double kGap_m = 0.5;           // half of what a lot closes between spaces
constexpr double kIntoLanelet_m = 0.3;   // that the way to a space reaches into the lanelet
constexpr double kShortestSide_m = 0.5;  // sides of a space
constexpr double kSimpler_m = 0.03;      // off a lot's outline

// A space entered over the side from corner k to the next.
struct Entry {
  Eigen::Vector3d front, back;
  double width_m;
  Eigen::Vector3d corner, next;
};

std::optional<Entry> space_axis_over(const PlannerSpace& space, std::size_t k) {
  const auto corner = [&](std::size_t i) { return space.corners[i % 4]; };
  Entry entry{0.5 * (corner(k) + corner(k + 1)), 0.5 * (corner(k + 2) + corner(k + 3)), 0.0,
              corner(k), corner(k + 1)};
  const Eigen::Vector2d along = (entry.back - entry.front).head<2>();
  const Eigen::Vector2d across = (entry.next - entry.corner).head<2>();
  if (along.norm() < kShortestSide_m || across.norm() < kShortestSide_m) return std::nullopt;
  entry.width_m = std::abs(along.x() * across.y() - along.y() * across.x()) / along.norm();
  return entry;
}

bool is_linked(const Entry& entry, const OGRGeometry& lanelet) {
  const Eigen::Vector3d before = entry.front - kLineLengths * (entry.back - entry.front);
  return line_of(entry.front, entry.back)->Distance(&lanelet) <= kLineReach_m &&
         line_of(before, entry.back)->Intersects(&lanelet) == TRUE;
}

// Lanelets of the lane, and of turns out of it and into it: near an intersection the lane's own
// end before the space.
std::vector<std::size_t> lanelets_of_lane(const LaneletNetwork& network,
                                          const LaneLayout& layout,
                                          int piece) {
  std::vector<std::size_t> lane;
  std::vector<std::size_t> turns;
  for (std::size_t i = 0; i < network.lanelets.size(); ++i) {
    const Lanelet& lanelet = network.lanelets[i];
    if (lanelet.piece == piece) lane.push_back(i);
    if (lanelet.connector < 0) continue;
    const Connector& turn = layout.connectors[static_cast<std::size_t>(lanelet.connector)];
    if (turn.from.piece == piece || turn.to.piece == piece) turns.push_back(i);
  }
  lane.insert(lane.end(), turns.begin(), turns.end());
  return lane;
}

void add_to_ground(OGRMultiPolygon& ground, const PlanGeometry& part) {
  if (part && wkbFlatten(part->getGeometryType()) == wkbPolygon) ground.addGeometry(part.get());
  if (part && wkbFlatten(part->getGeometryType()) == wkbMultiPolygon)
    for (const auto* one : *part->toMultiPolygon()) ground.addGeometry(one);
}

// The space and the way to it, which is as long as its middle line before it is in the lanelet.
void add_ground(const PlannerSpace& space,
                const Entry& entry,
                const OGRGeometry& lanelet,
                OGRMultiPolygon& ground) {
  constexpr int kCornerSegments = 2;
  add_to_ground(ground,
                PlanGeometry(polygon_of(space.corners)->Buffer(kMargin_m, kCornerSegments)));
  const Eigen::Vector3d out = (entry.front - entry.back).normalized();
  const double farthest = kLineLengths * (entry.front - entry.back).norm();
  double way_m = 0.0;
  while (way_m < farthest &&
         line_of(entry.front, entry.front + way_m * out)->Distance(&lanelet) > 0.0)
    way_m += kMargin_m;
  way_m += kIntoLanelet_m;
  add_to_ground(
      ground, polygon_of(std::vector<Eigen::Vector3d>{
                  entry.corner, entry.next, entry.next + way_m * out, entry.corner + way_m * out}));
}

// Outer rings of the ground, gaps between spaces closed; heights from the nearest point known.
std::vector<std::vector<Eigen::Vector3d>> lots_of(const OGRMultiPolygon& ground,
                                                  const std::vector<Eigen::Vector3d>& known) {
  std::vector<std::vector<Eigen::Vector3d>> lots;
  if (ground.IsEmpty()) return lots;
  constexpr int kCornerSegments = 2;
  const PlanGeometry whole(ground.UnionCascaded());
  const PlanGeometry wider(whole->Buffer(kGap_m, kCornerSegments));
  const PlanGeometry closed(wider->Buffer(-kGap_m, kCornerSegments));
  const PlanGeometry simple(closed->SimplifyPreserveTopology(kSimpler_m));
  const auto height_at = [&](const Eigen::Vector2d& p) {
    return std::min_element(known.begin(), known.end(),
                            [&](const auto& a, const auto& b) {
                              return (a.template head<2>() - p).squaredNorm() <
                                     (b.template head<2>() - p).squaredNorm();
                            })
        ->z();
  };
  const auto add = [&](const OGRPolygon& polygon) {
    const OGRLinearRing& ring = *polygon.getExteriorRing();
    lots.emplace_back();
    for (int i = 0; i + 1 < ring.getNumPoints(); ++i)
      lots.back().emplace_back(ring.getX(i), ring.getY(i), height_at({ring.getX(i), ring.getY(i)}));
  };
  if (wkbFlatten(simple->getGeometryType()) == wkbPolygon) add(*simple->toPolygon());
  if (wkbFlatten(simple->getGeometryType()) == wkbMultiPolygon)
    for (const auto* one : *simple->toMultiPolygon()) add(*one);
  return lots;
}

}  // namespace

AutowareParking autoware_parking(const PlannerMap& map, const LaneletNetwork& network) {
  AutowareParking parking;
  OGRMultiPolygon ground;
  std::vector<Eigen::Vector3d> known;  // heights
  std::set<std::size_t> linked;        // lanelets
  std::vector<PlanGeometry> lanelets(network.lanelets.size());
  const auto lanelet_at = [&](std::size_t i) -> const OGRGeometry& {
    if (!lanelets[i]) lanelets[i] = polygon_of(network.lanelets[i].bounds);
    return *lanelets[i];
  };
  for (std::size_t i = 0; i < map.spaces().size(); ++i) {
    const PlannerSpace& space = map.spaces()[i];
    if (!space.rectangle) {
      ++parking.no_rectangle;
      continue;
    }
    std::optional<std::pair<Entry, std::size_t>> found;
    const auto near = space.link ? lanelets_of_lane(network, map.layout(), space.link->piece)
                                 : std::vector<std::size_t>();
    for (const std::size_t side : {0U, 1U, 3U, 2U})
      for (const std::size_t lanelet : near) {
        const auto entry = space_axis_over(space, side);
        if (!found && entry && is_linked(*entry, lanelet_at(lanelet))) found = {*entry, lanelet};
      }
    if (!found) {
      ++parking.no_lane;
      continue;
    }
    const auto& [entry, lanelet] = *found;
    parking.spaces.push_back({i, entry.front, entry.back, entry.width_m, lanelet});
    add_ground(space, entry, lanelet_at(lanelet), ground);
    linked.insert(lanelet);
    known.insert(known.end(), space.corners.begin(), space.corners.end());
  }
  for (const std::size_t i : linked) {
    add_to_ground(ground, PlanGeometry(lanelet_at(i).clone()));
    const LaneBounds& bounds = network.lanelets[i].bounds;
    for (std::size_t k = 0; k < bounds.left.size(); k += 10) known.push_back(bounds.left[k]);
  }
  parking.lots = lots_of(ground, known);
  return parking;
}

}  // namespace roadbook
