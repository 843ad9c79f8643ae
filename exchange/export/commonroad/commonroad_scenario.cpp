#include "exchange/export/commonroad/commonroad_scenario.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "exchange/export/planner/crosswalk.hpp"
#include "exchange/export/planner/plan_polygon.hpp"

namespace roadbook {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kLevel_m = 0.5;  // height differences that a flat format may lose unsaid

void append_reference(pugi::xml_node parent, const char* name, std::uint64_t id) {
  append_element(parent, name, {{"ref", std::to_string(id)}});
}

void append_exact(pugi::xml_node state, const char* name, const std::string& value) {
  append_text(append_element(state, name), "exact", value);
}

// Places that both bounds need, so that they have as many points: CommonRoad takes the centre
// between the two of a place.
std::vector<std::size_t> common_places(const LaneBounds& bounds) {
  std::vector<std::size_t> places{0};
  while (places.back() + 1 < bounds.s_m.size()) {
    std::size_t next = places.back() + 1;
    while (next + 1 < bounds.s_m.size() && chord_fits(bounds.left, places.back(), next + 1) &&
           chord_fits(bounds.right, places.back(), next + 1))
      ++next;
    places.push_back(next);
  }
  return places;
}

}  // namespace

CommonRoadScenario::CommonRoadScenario(pugi::xml_node root,
                                       const PlannerMap& map,
                                       const ToDegrees* to_degrees,
                                       std::string sign)
    : map_(map),
      to_degrees_(to_degrees),
      sign_(std::move(sign)),
      network_(lanelets_of(map)),
      lanelets_(directed_lanelets(network_)),
      end_of_lanelets_(append_place(root)),
      end_of_signs_(append_place(root)),
      end_of_intersections_(append_place(root)),
      end_of_problems_(append_place(root)) {
  for (const DirectedLanelet& one : lanelets_) used_.insert(one.lanelet.id);
}

void CommonRoadScenario::append_point(pugi::xml_node parent, const Eigen::Vector3d& p) const {
  const Eigen::Vector2d q = place(p);
  const pugi::xml_node point = append_element(parent, "point");
  append_text(point, "x", fixed_text(q.x(), 4));
  append_text(point, "y", fixed_text(q.y(), 4));
}

void CommonRoadScenario::append_bound(pugi::xml_node lanelet,
                                      const char* name,
                                      const std::vector<Eigen::Vector3d>& line) const {
  const pugi::xml_node bound = append_element(lanelet, name);
  for (const Eigen::Vector3d& p : line) append_point(bound, p);
}

// A limit without an observed sign: the speed of the speed profile.
std::uint64_t CommonRoadScenario::add_limit(const Lanelet& lanelet) {
  const std::uint64_t id = next_id();
  const double speed = std::floor(lanelet.speed * 1e4 + 1e-6) / 1e4;
  const auto sign = insert_line(end_of_signs_, "trafficSign", {{"id", std::to_string(id)}});
  const auto element = append_element(sign, "trafficSignElement");
  append_text(element, "trafficSignID", sign_);
  append_text(element, "additionalValue", fixed_text(std::max(speed, 1e-4), 4));
  append_point(append_element(sign, "position"), lanelet.bounds.right.front());
  append_text(sign, "virtual", "true");
  return id;
}

void CommonRoadScenario::add_roads() {
  for (const DirectedLanelet& one : lanelets_) {
    std::vector<Eigen::Vector3d> left;
    std::vector<Eigen::Vector3d> right;
    for (const std::size_t i : common_places(one.lanelet.bounds)) {
      left.push_back(one.lanelet.bounds.left[i]);
      right.push_back(one.lanelet.bounds.right[i]);
    }
    const auto lanelet =
        insert_line(end_of_lanelets_, "lanelet", {{"id", std::to_string(one.lanelet.id)}});
    append_bound(lanelet, "leftBound", left);
    append_bound(lanelet, "rightBound", right);
    for (const std::size_t i : one.predecessors)
      append_reference(lanelet, "predecessor", lanelets_[i].lanelet.id);
    for (const std::size_t i : one.successors)
      append_reference(lanelet, "successor", lanelets_[i].lanelet.id);
    append_text(lanelet, "laneletType", "urban");
    if (one.lanelet.connector >= 0) append_text(lanelet, "laneletType", "intersection");
    append_text(lanelet, "userOneWay", "vehicle");
    append_reference(lanelet, "trafficSignRef", add_limit(one.lanelet));
  }
}

void CommonRoadScenario::add_place(std::uint64_t id,
                                   const std::vector<Eigen::Vector3d>& left,
                                   const std::vector<Eigen::Vector3d>& right,
                                   const std::string& kind) {
  const auto lanelet = insert_line(end_of_lanelets_, "lanelet", {{"id", std::to_string(id)}});
  append_bound(lanelet, "leftBound", left);
  append_bound(lanelet, "rightBound", right);
  append_text(lanelet, "laneletType", kind);
  append_text(lanelet, "userBidirectional", kind == "parking" ? "vehicle" : "pedestrian");
}

void CommonRoadScenario::add_crossings(ExportNotes& notes) {
  for (const Crosswalk& walk : crosswalks_of(map_, network_, false, notes))
    add_place(stable_id(walk.label, LabelKind::kCrossing), {walk.left[0], walk.left[1]},
              {walk.right[0], walk.right[1]}, "crosswalk");
}

// Lanelets from the open side inwards; nothing leads into them, as no lanelet ends there.
void CommonRoadScenario::add_parking(ExportNotes& notes) {
  std::size_t empty = 0;
  std::size_t other_shape = 0;
  std::size_t links = 0;
  for (const PlannerSpace& space : map_.spaces()) {
    if (!encloses_ground(space.corners)) {
      ++empty;
      continue;
    }
    if (!space.rectangle) {
      ++other_shape;
      continue;
    }
    const auto& c = space.corners;
    const Eigen::Vector2d a = (c[1] - c[0]).head<2>();
    const Eigen::Vector2d b = (c[3] - c[0]).head<2>();
    const bool counter_clockwise = a.x() * b.y() - a.y() * b.x() > 0.0;
    std::vector<Eigen::Vector3d> left{c[0], c[3]};
    std::vector<Eigen::Vector3d> right{c[1], c[2]};
    if (!counter_clockwise) std::swap(left, right);
    add_place(stable_id(space.id, LabelKind::kSpace), left, right, "parking");
    links += space.link ? 1 : 0;
  }
  add_note(notes, "parking spaces", empty, "their outline encloses no ground or crosses itself");
  add_note(notes, "parking spaces", other_shape,
           "a lanelet lies between two bounds; --format lanelet2 writes any shape");
  add_note(notes, "links of parking spaces to lanes", links,
           "CommonRoad has no place for them; --format lanelet2 --profile autoware has");
}

// One incoming for each lanelet that ends at an intersection, with its turns by direction.
void CommonRoadScenario::add_intersections() {
  std::map<int, std::set<std::size_t>> incoming;  // by intersection of the network
  for (const DirectedLanelet& turn : lanelets_)
    if (turn.lanelet.connector >= 0)
      incoming
          [map_.layout().connectors[static_cast<std::size_t>(turn.lanelet.connector)].intersection]
              .insert(turn.predecessors.begin(), turn.predecessors.end());
  for (const auto& [intersection, lanes] : incoming) {
    if (lanes.empty()) continue;
    const auto element =
        insert_line(end_of_intersections_, "intersection", {{"id", std::to_string(next_id())}});
    for (const std::size_t lane : lanes) add_incoming(element, lane);
  }
}

// The lanelet that ends at the intersection, then its turns in the schema's order.
void CommonRoadScenario::add_incoming(pugi::xml_node intersection, std::size_t lane) {
  constexpr std::array kNames{"successorsRight", "successorsStraight", "successorsLeft"};
  const auto incoming =
      append_element(intersection, "incoming", {{"id", std::to_string(next_id())}});
  append_reference(incoming, "incomingLanelet", lanelets_[lane].lanelet.id);
  for (std::size_t direction = 0; direction < kNames.size(); ++direction)
    for (const std::size_t next : lanelets_[lane].successors) {
      const Lanelet& turn = lanelets_[next].lanelet;
      if (turn.connector >= 0 && static_cast<std::size_t>(turn_direction(turn)) == direction)
        append_reference(incoming, kNames[direction], turn.id);
    }
}

void CommonRoadScenario::add_problem() {
  constexpr double kSlower = 3.0;  // than the limits, a vehicle may be
  const LaneletTrip trip = longest_trip(lanelets_);
  const LaneBounds& first = lanelets_[trip.from].lanelet.bounds;
  const Eigen::Vector2d across = place(first.left[0]) - place(first.right[0]);
  const auto latest = static_cast<std::int64_t>(std::ceil(kSlower * trip.time_s / kStep_s)) + 100;
  const auto problem =
      insert_line(end_of_problems_, "planningProblem", {{"id", std::to_string(next_id())}});
  const auto initial = append_element(problem, "initialState");
  append_point(append_element(initial, "position"), 0.5 * (first.left[0] + first.right[0]));
  append_exact(initial, "velocity", "0.0");
  append_exact(initial, "orientation", fixed_text(std::atan2(-across.x(), across.y()), 6));
  append_exact(initial, "yawRate", "0.0");
  append_exact(initial, "slipAngle", "0.0");
  append_exact(initial, "time", "0");
  const auto goal = append_element(problem, "goalState");
  const auto time = append_element(goal, "time");
  append_text(time, "intervalStart", "0");
  append_text(time, "intervalEnd", std::to_string(latest));
  append_reference(append_element(goal, "position"), "lanelet", lanelets_[trip.to].lanelet.id);
}

void CommonRoadScenario::count_heights(ExportNotes& notes) const {
  double low = INFINITY;
  double high = -INFINITY;
  for (const DirectedLanelet& one : lanelets_)
    for (const Eigen::Vector3d& p : one.lanelet.bounds.left) {
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
  add_note(notes, "heights of lanelets", high - low > kLevel_m ? lanelets_.size() : 0,
           "CommonRoad's planners work in plan; --format lanelet2 writes them");
}

}  // namespace roadbook
