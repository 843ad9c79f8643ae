#include "exchange/export/opendrive/opendrive_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "exchange/export/opendrive/opendrive_places.hpp"
#include "roadnet/floor_height.hpp"

namespace roadbook {
namespace {

constexpr double kSameDistance_m = 1e-6;
constexpr double kOtherFloor_m = 1e6;
constexpr double kNearRoad_m = 15.0;
constexpr double kMostDeviating_m = 0.01;

Eigen::Vector2d left_of(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

std::array<Eigen::Vector2d, 4> corners_of(const OutlineBox& box) {
  const Eigen::Vector2d l = 0.5 * box.length_m * box.ahead;
  const Eigen::Vector2d w = 0.5 * box.width_m * left_of(box.ahead);
  return {box.middle - l - w, box.middle - l + w, box.middle + l + w, box.middle + l - w};
}

// Sides along `ahead` and across it that hold all corners.
OutlineBox bounds(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector2d& ahead) {
  const Eigen::Vector2d across = left_of(ahead);
  Eigen::Vector2d low = Eigen::Vector2d::Constant(INFINITY);
  Eigen::Vector2d high = -low;
  for (const Eigen::Vector3d& c : corners) {
    const Eigen::Vector2d p(ahead.dot(c.head<2>()), across.dot(c.head<2>()));
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d middle = 0.5 * (low + high);
  return {middle.x() * ahead + middle.y() * across, ahead, high.x() - low.x(), high.y() - low.y()};
}

OutlineBox box_of_four(const std::vector<Eigen::Vector3d>& c) {
  OutlineBox box;
  const Eigen::Vector2d a = (c[3] - c[0] + c[2] - c[1]).head<2>() / 2.0;
  const Eigen::Vector2d b = (c[1] - c[0] + c[2] - c[3]).head<2>() / 2.0;
  box.middle = (c[0] + c[1] + c[2] + c[3]).head<2>() / 4.0;
  box.length_m = a.norm();
  box.ahead = box.length_m > 0.0 ? Eigen::Vector2d(a / box.length_m) : Eigen::Vector2d::UnitX();
  box.width_m = std::abs(left_of(box.ahead).dot(b));
  return box;
}

OutlineBox smallest_box(const std::vector<Eigen::Vector3d>& corners) {
  OutlineBox best = bounds(corners, Eigen::Vector2d::UnitX());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d side = (corners[(i + 1) % corners.size()] - corners[i]).head<2>();
    if (!(side.norm() > 1e-6)) continue;
    const OutlineBox box = bounds(corners, side.normalized());
    if (box.length_m * box.width_m < best.length_m * best.width_m) best = box;
  }
  return best;
}

// A space or crossing before its road is complete.
struct Placed {
  const std::vector<Eigen::Vector3d>* corners = nullptr;
  std::string id;
  bool crossing = false;
  const SpaceLink* link = nullptr;
  OutlineBox box;
  double height_m = 0.0;  // mean of the corners
};

Placed placed(const std::vector<Eigen::Vector3d>& corners,
              const std::string& id,
              bool crossing,
              const SpaceLink* link) {
  Placed one{&corners, id, crossing, link, box_of(corners)};
  for (const Eigen::Vector3d& c : corners)
    one.height_m += c.z() / static_cast<double>(corners.size());
  return one;
}

class ObjectPlacer {
 public:
  ObjectPlacer(const PlannerMap& planner, const DriveRoads& roads)
      : planner_(planner), roads_(roads), feet_(roads.roads.size()), placed_(roads.roads.size()) {
    all_.of_road.resize(roads.roads.size());
  }

  DriveObjects place() {
    std::vector<Placed> all;
    for (const PlannerSpace& space : planner_.spaces())
      all.push_back(
          placed(space.corners, "space_" + space.id, false, space.link ? &*space.link : nullptr));
    for (const PlannerCrossing& crossing : planner_.crossings())
      all.push_back(placed(crossing.corners, "crossing_" + crossing.id, true, nullptr));
    // Those that need a road far away take no room from others.
    std::vector<Placed> far;
    for (Placed& one : all)
      if (!add(one, kNearRoad_m)) far.push_back(std::move(one));
    for (Placed& one : far)
      if (!add(one, INFINITY)) {
        ++all_.displaced;
        placed_[nearest_end(one.box.middle).road].push_back(std::move(one));
      }
    for (std::size_t i = 0; i < placed_.size(); ++i)
      for (const Placed& one : placed_[i]) {
        all_.not_rectangles += one.box.deviation_m > kMostDeviating_m ? 1U : 0U;
        all_.of_road[i].objects.push_back(object_beside(i, one));
      }
    return std::move(all_);
  }

 private:
  bool add(Placed& one, double reach_m) {
    auto road = one.link != nullptr ? first_road(one, true, reach_m) : std::nullopt;
    if (!road) road = first_road(one, false, reach_m);
    if (!road) return false;
    placed_[*road].push_back(std::move(one));
    return true;
  }

  // The nearest road with room on its side: of those of the link, or of all others.
  std::optional<std::size_t> first_road(const Placed& one, bool linked, double reach_m) {
    std::vector<std::pair<std::size_t, RoadFoot>> feet;
    for (std::size_t i = 0; i < roads_.roads.size(); ++i) {
      const DriveRoad& road = roads_.roads[i];
      const bool of_link = one.link != nullptr && road.piece == one.link->piece;
      if (road.piece < 0 || of_link != linked || !may_reach(road, one.box.middle, reach_m))
        continue;
      for (const RoadFoot& foot : feet_of(road, one.box.middle))
        if (sort_distance(road, foot, one) <= reach_m) feet.emplace_back(i, foot);
    }
    std::stable_sort(feet.begin(), feet.end(), [&](const auto& a, const auto& b) {
      return std::round(sort_distance(roads_.roads[a.first], a.second, one) / kSameDistance_m) <
             std::round(sort_distance(roads_.roads[b.first], b.second, one) / kSameDistance_m);
    });
    for (const auto& [road, foot] : feet)
      if (takes(road, foot)) return road;
    return std::nullopt;
  }

  // A road reaches no farther than half its length from its middle.
  static bool may_reach(const DriveRoad& road, const Eigen::Vector2d& p, double reach_m) {
    const PathPoint middle = road.curve.at(0.5 * (road.begin_m + road.end_m));
    return (p - middle.position).norm() <= 0.5 * road.length_m() + reach_m;
  }

  // From a road; roads of other floors come after all others. In steps, so that of a pair of roads
  // the one driven forwards comes first.
  static double sort_distance(const DriveRoad& road, const RoadFoot& foot, const Placed& one) {
    const double rise = road.curve.at(foot.s_m).height_m - one.height_m;
    return std::abs(foot.t_m) + (std::abs(rise) > kFloorHeight_m ? kOtherFloor_m : 0.0);
  }

  bool takes(std::size_t road, const RoadFoot& foot) {
    std::vector<RoadFoot> feet = feet_[road];
    feet.push_back(foot);
    const auto stretches = stretches_across(roads_.roads[road], feet);
    if (!stretches) return false;
    feet_[road] = std::move(feet);
    all_.of_road[road].stretches = *stretches;
    return true;
  }

  [[nodiscard]] DriveObject object_beside(std::size_t number, const Placed& one) const {
    const DriveRoad& road = roads_.roads[number];
    const auto found = place_across(road, all_.of_road[number].stretches, one.box.middle);
    const ChordPlace place = found ? *found : nearest_end(one.box.middle).place;
    const double direction = std::atan2(one.box.ahead.y(), one.box.ahead.x());
    DriveObject object{one.crossing, one.id, place.s_m - road.begin_m, place.t_m};
    object.turn_rad = std::remainder(direction - place.heading_rad, 2.0 * std::numbers::pi);
    object.length_m = one.box.length_m;
    object.width_m = one.box.width_m;
    object.link = one.link;
    // The outline counts from where the curve, not a chord, has the object.
    const PathPoint at = road.curve.at(place.s_m);
    object.z_m = one.height_m - at.height_m;
    const Eigen::Vector2d origin = at.position + place.t_m * at.left();
    const double ahead_rad = at.heading() + object.turn_rad;
    const Eigen::Vector2d ahead(std::cos(ahead_rad), std::sin(ahead_rad));
    for (const Eigen::Vector3d& c : *one.corners) {
      const Eigen::Vector2d p = c.head<2>() - origin;
      object.outline.emplace_back(ahead.dot(p), left_of(ahead).dot(p), c.z() - one.height_m);
    }
    return object;
  }

  struct RoadEnd {
    std::size_t road = 0;
    ChordPlace place;
  };
  // The end of all lanes' roads that is nearest to a point without a road at its side.
  [[nodiscard]] RoadEnd nearest_end(const Eigen::Vector2d& p) const {
    RoadEnd best;
    double nearest = INFINITY;
    for (std::size_t i = 0; i < roads_.roads.size(); ++i) {
      const DriveRoad& road = roads_.roads[i];
      if (road.piece < 0) continue;
      for (const double s : {road.begin_m, road.end_m}) {
        const PathPoint at = road.curve.at(s);
        const Eigen::Vector2d across = p - at.position;
        if (!(across.norm() < nearest)) continue;
        nearest = across.norm();
        best = {i, {s, at.left().dot(across), at.heading()}};
      }
    }
    return best;
  }

  const PlannerMap& planner_;
  const DriveRoads& roads_;
  DriveObjects all_;
  std::vector<std::vector<RoadFoot>> feet_;  // of a road
  std::vector<std::vector<Placed>> placed_;  // by road
};

}  // namespace

OutlineBox box_of(const std::vector<Eigen::Vector3d>& corners) {
  OutlineBox box = corners.size() == 4 ? box_of_four(corners) : smallest_box(corners);
  for (const Eigen::Vector2d& corner : corners_of(box)) {
    double nearest = INFINITY;
    for (const Eigen::Vector3d& c : corners)
      nearest = std::min(nearest, (c.head<2>() - corner).norm());
    box.deviation_m = std::max(box.deviation_m, nearest);
  }
  return box;
}

DriveObjects drive_objects(const PlannerMap& planner, const DriveRoads& roads) {
  return ObjectPlacer(planner, roads).place();
}

}  // namespace roadbook
