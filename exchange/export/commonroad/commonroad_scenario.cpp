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

std::string xml_reference(const std::string& name, std::uint64_t id) {
  return "<" + name + " ref=\"" + std::to_string(id) + "\"/>";
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

std::string xml_element(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}

std::string CommonRoadScenario::bound(const char* name,
                                      const std::vector<Eigen::Vector3d>& line) const {
  std::string points;
  for (const Eigen::Vector3d& p : line) points += point(p);
  return xml_element(name, points);
}

// A limit without an observed sign: the speed of the speed profile.
std::uint64_t CommonRoadScenario::add_limit(const Lanelet& lanelet) {
  const std::uint64_t id = next_id();
  const double speed = std::floor(lanelet.speed * 1e4 + 1e-6) / 1e4;
  sign_text_ +=
      "  <trafficSign id=\"" + std::to_string(id) + "\">" +
      xml_element("trafficSignElement",
                  xml_element("trafficSignID", sign_) +
                      xml_element("additionalValue", fixed_text(std::max(speed, 1e-4), 4))) +
      xml_element("position", point(lanelet.bounds.right.front())) +
      xml_element("virtual", "true") + "</trafficSign>\n";
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
    lanelet_text_ += "  <lanelet id=\"" + std::to_string(one.lanelet.id) + "\">" +
                     bound("leftBound", left) + bound("rightBound", right);
    for (const std::size_t i : one.predecessors)
      lanelet_text_ += xml_reference("predecessor", lanelets_[i].lanelet.id);
    for (const std::size_t i : one.successors)
      lanelet_text_ += xml_reference("successor", lanelets_[i].lanelet.id);
    lanelet_text_ += xml_element("laneletType", "urban");
    if (one.lanelet.connector >= 0) lanelet_text_ += xml_element("laneletType", "intersection");
    lanelet_text_ += xml_element("userOneWay", "vehicle") +
                     xml_reference("trafficSignRef", add_limit(one.lanelet)) + "</lanelet>\n";
  }
}

void CommonRoadScenario::add_place(std::uint64_t id,
                                   const std::vector<Eigen::Vector3d>& left,
                                   const std::vector<Eigen::Vector3d>& right,
                                   const std::string& kind) {
  lanelet_text_ += "  <lanelet id=\"" + std::to_string(id) + "\">" + bound("leftBound", left) +
                   bound("rightBound", right) + xml_element("laneletType", kind) +
                   xml_element("userBidirectional", kind == "parking" ? "vehicle" : "pedestrian") +
                   "</lanelet>\n";
}

void CommonRoadScenario::add_crossings(ExportNotes& notes) {
  std::size_t empty = 0;
  std::size_t other_shape = 0;
  for (const PlannerCrossing& crossing : map_.crossings()) {
    const auto walk = crosswalk_of(crossing, network_);
    if (!walk) {
      ++empty;
      continue;
    }
    other_shape += walk->rectangle ? 0 : 1;
    add_place(stable_id(crossing.id, LabelKind::kCrossing), {walk->left[0], walk->left[1]},
              {walk->right[0], walk->right[1]}, "crosswalk");
  }
  add_note(notes, "crossings", empty, "their outline encloses no ground or crosses itself");
  add_note(notes, "outlines of crossings", other_shape,
           "a crosswalk has two bounds; the rectangle around the outline is written");
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
    intersection_text_ += "  <intersection id=\"" + std::to_string(next_id()) + "\">";
    for (const std::size_t lane : lanes) {
      // The schema's order.
      constexpr std::array kNames{"successorsRight", "successorsStraight", "successorsLeft"};
      std::array<std::string, 3> turns;
      for (const std::size_t next : lanelets_[lane].successors) {
        if (lanelets_[next].lanelet.connector < 0) continue;
        const TurnDirection turn = turn_direction(lanelets_[next].lanelet);
        turns[static_cast<std::size_t>(turn)] +=
            xml_reference(kNames[static_cast<std::size_t>(turn)], lanelets_[next].lanelet.id);
      }
      intersection_text_ += "<incoming id=\"" + std::to_string(next_id()) + "\">" +
                            xml_reference("incomingLanelet", lanelets_[lane].lanelet.id) +
                            turns[0] + turns[1] + turns[2] + "</incoming>";
    }
    intersection_text_ += "</intersection>\n";
  }
}

void CommonRoadScenario::add_problem() {
  constexpr double kSlower = 3.0;  // than the limits, a vehicle may be
  const LaneletTrip trip = longest_trip(lanelets_);
  const LaneBounds& first = lanelets_[trip.from].lanelet.bounds;
  const Eigen::Vector2d across = place(first.left[0]) - place(first.right[0]);
  const auto exact = [](const std::string& value) { return xml_element("exact", value); };
  const auto latest = static_cast<std::int64_t>(std::ceil(kSlower * trip.time_s / kStep_s)) + 100;
  problem_text_ =
      "  <planningProblem id=\"" + std::to_string(next_id()) + "\">" +
      xml_element("initialState",
                  xml_element("position", point(0.5 * (first.left[0] + first.right[0]))) +
                      xml_element("velocity", exact("0.0")) +
                      xml_element("orientation",
                                  exact(fixed_text(std::atan2(-across.x(), across.y()), 6))) +
                      xml_element("yawRate", exact("0.0")) +
                      xml_element("slipAngle", exact("0.0")) + xml_element("time", exact("0"))) +
      xml_element(
          "goalState",
          xml_element("time", xml_element("intervalStart", "0") +
                                  xml_element("intervalEnd", std::to_string(latest))) +
              xml_element("position", xml_reference("lanelet", lanelets_[trip.to].lanelet.id))) +
      "</planningProblem>\n";
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
