#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "base/error.hpp"
#include "exchange/commonroad_network.hpp"
#include "exchange/crosswalk.hpp"
#include "exchange/export_formats.hpp"
#include "exchange/geo_origin.hpp"
#include "exchange/output_file.hpp"
#include "exchange/plan_polygon.hpp"
#include "mapping/map_layers_gdal.hpp"

// CommonRoad scenarios, XML format 2020a (schema XML_commonRoad_XSD.xsd of commonroad-io). Speed
// limits are traffic signs that a lanelet refers to. The schema wants a planning problem: from the
// begin of the first lanelet to the one that takes longest to reach.

namespace roadbook {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kStraight_rad = 0.5236;  // 30 degrees
constexpr double kLevel_m = 0.5;          // height differences that a flat format may lose unsaid

// The sign of a speed limit by country, as far as the schema knows it.
const std::vector<std::pair<std::string, std::string>>& speed_signs() {
  static const std::vector<std::pair<std::string, std::string>> signs{
      {"ZAM", "274"},  {"DEU", "274"},  {"CHN", "274"}, {"ITA", "274"},
      {"USA", "R2-1"}, {"PRI", "R2-1"}, {"ESP", "r301"}};
  return signs;
}

std::string element(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}
std::string reference(const std::string& name, std::uint64_t id) {
  return "<" + name + " ref=\"" + std::to_string(id) + "\"/>";
}

class Scenario {
 public:
  Scenario(const PlannerMap& map, const ToDegrees* to_degrees, std::string sign)
      : map_(map),
        to_degrees_(to_degrees),
        sign_(std::move(sign)),
        network_(lanelets_of(map)),
        lanelets_(directed_lanelets(network_)) {
    for (const DirectedLanelet& one : lanelets_) used_.insert(one.lanelet.id);
  }

  [[nodiscard]] bool empty() const { return lanelets_.empty(); }
  void add_roads();
  void add_crossings(ExportNotes& notes);
  void add_parking(ExportNotes& notes);
  void add_intersections();
  void add_problem();
  void count_heights(ExportNotes& notes) const;
  [[nodiscard]] std::string text() const {
    return lanelet_text_ + sign_text_ + intersection_text_ + problem_text_;
  }
  [[nodiscard]] bool has_turns() const { return !map_.layout().connectors.empty(); }

 private:
  [[nodiscard]] Eigen::Vector2d place(const Eigen::Vector3d& p) const {
    return to_degrees_ != nullptr ? to_degrees_->east_north(p.head<2>()) : p.head<2>();
  }
  [[nodiscard]] std::string point(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d q = place(p);
    return element("point",
                   element("x", fixed_text(q.x(), 4)) + element("y", fixed_text(q.y(), 4)));
  }
  [[nodiscard]] std::string bound(const char* name, const std::vector<Eigen::Vector3d>& line) const;
  std::uint64_t next_id() {
    while (!used_.insert(++last_).second) {
    }
    return last_;
  }
  std::uint64_t stable_id(const std::string& label, LabelKind kind) {
    std::uint64_t id = id_of_label(label, kind);
    while (!used_.insert(id).second) ++id;
    return id;
  }
  std::uint64_t add_limit(const Lanelet& lanelet);
  void add_place(std::uint64_t id,
                 const std::vector<Eigen::Vector3d>& left,
                 const std::vector<Eigen::Vector3d>& right,
                 const std::string& kind);

  const PlannerMap& map_;
  const ToDegrees* to_degrees_;
  std::string sign_;
  LaneletNetwork network_;
  std::vector<DirectedLanelet> lanelets_;
  std::uint64_t last_ = 0;
  std::set<std::uint64_t> used_;
  std::string lanelet_text_, sign_text_, intersection_text_, problem_text_;
};

std::string Scenario::bound(const char* name, const std::vector<Eigen::Vector3d>& line) const {
  std::string points;
  for (const Eigen::Vector3d& p : line) points += point(p);
  return element(name, points);
}

// Places that both bounds need, so that they have as many points: CommonRoad takes the centre
// between the two of a place.
std::vector<std::size_t> places_of(const LaneBounds& bounds) {
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

// A sign that nobody saw: what the speed profile allows.
std::uint64_t Scenario::add_limit(const Lanelet& lanelet) {
  const std::uint64_t id = next_id();
  const double speed = std::floor(lanelet.speed * 1e4 + 1e-6) / 1e4;
  sign_text_ += "  <trafficSign id=\"" + std::to_string(id) + "\">" +
                element("trafficSignElement",
                        element("trafficSignID", sign_) +
                            element("additionalValue", fixed_text(std::max(speed, 1e-4), 4))) +
                element("position", point(lanelet.bounds.right.front())) +
                element("virtual", "true") + "</trafficSign>\n";
  return id;
}

void Scenario::add_roads() {
  for (const DirectedLanelet& one : lanelets_) {
    std::vector<Eigen::Vector3d> left;
    std::vector<Eigen::Vector3d> right;
    for (const std::size_t i : places_of(one.lanelet.bounds)) {
      left.push_back(one.lanelet.bounds.left[i]);
      right.push_back(one.lanelet.bounds.right[i]);
    }
    lanelet_text_ += "  <lanelet id=\"" + std::to_string(one.lanelet.id) + "\">" +
                     bound("leftBound", left) + bound("rightBound", right);
    for (const std::size_t i : one.predecessors)
      lanelet_text_ += reference("predecessor", lanelets_[i].lanelet.id);
    for (const std::size_t i : one.successors)
      lanelet_text_ += reference("successor", lanelets_[i].lanelet.id);
    lanelet_text_ += element("laneletType", "urban");
    if (one.lanelet.connector >= 0) lanelet_text_ += element("laneletType", "intersection");
    lanelet_text_ += element("userOneWay", "vehicle") +
                     reference("trafficSignRef", add_limit(one.lanelet)) + "</lanelet>\n";
  }
}

void Scenario::add_place(std::uint64_t id,
                         const std::vector<Eigen::Vector3d>& left,
                         const std::vector<Eigen::Vector3d>& right,
                         const std::string& kind) {
  lanelet_text_ += "  <lanelet id=\"" + std::to_string(id) + "\">" + bound("leftBound", left) +
                   bound("rightBound", right) + element("laneletType", kind) +
                   element("userBidirectional", kind == "parking" ? "vehicle" : "pedestrian") +
                   "</lanelet>\n";
}

void Scenario::add_crossings(ExportNotes& notes) {
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
void Scenario::add_parking(ExportNotes& notes) {
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

// Of a turn, left positive.
double turned_rad(const LaneBounds& bounds) {
  const auto direction = [&](std::size_t i) {
    const Eigen::Vector3d across = bounds.left[i] - bounds.right[i];
    return Eigen::Vector2d(across.y(), -across.x());
  };
  const Eigen::Vector2d a = direction(0);
  const Eigen::Vector2d b = direction(bounds.s_m.size() - 1);
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

// One incoming for each lanelet that ends at an intersection, with its turns by direction.
void Scenario::add_intersections() {
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
      std::array<std::string, 3> turns;  // right, straight, left: the schema's order
      for (const std::size_t next : lanelets_[lane].successors) {
        if (lanelets_[next].lanelet.connector < 0) continue;
        const double turn = turned_rad(lanelets_[next].lanelet.bounds);
        const bool straight = std::abs(turn) < kStraight_rad;
        turns[straight     ? 1
              : turn < 0.0 ? 0
                           : 2] += reference(straight     ? "successorsStraight"
                                             : turn < 0.0 ? "successorsRight"
                                                          : "successorsLeft",
                                             lanelets_[next].lanelet.id);
      }
      intersection_text_ += "<incoming id=\"" + std::to_string(next_id()) + "\">" +
                            reference("incomingLanelet", lanelets_[lane].lanelet.id) + turns[0] +
                            turns[1] + turns[2] + "</incoming>";
    }
    intersection_text_ += "</intersection>\n";
  }
}

void Scenario::add_problem() {
  constexpr double kSlower = 3.0;  // than the limits, a vehicle may be
  const FarthestLanelet goal = farthest_from(lanelets_, 0);
  const LaneBounds& first = lanelets_.front().lanelet.bounds;
  const Eigen::Vector2d across = place(first.left[0]) - place(first.right[0]);
  const auto exact = [](const std::string& value) { return element("exact", value); };
  const auto latest = static_cast<std::int64_t>(std::ceil(kSlower * goal.time_s / kStep_s)) + 100;
  problem_text_ =
      "  <planningProblem id=\"" + std::to_string(next_id()) + "\">" +
      element(
          "initialState",
          element("position", point(0.5 * (first.left[0] + first.right[0]))) +
              element("velocity", exact("0.0")) +
              element("orientation", exact(fixed_text(std::atan2(-across.x(), across.y()), 6))) +
              element("yawRate", exact("0.0")) + element("slipAngle", exact("0.0")) +
              element("time", exact("0"))) +
      element("goalState",
              element("time", element("intervalStart", "0") +
                                  element("intervalEnd", std::to_string(latest))) +
                  element("position", reference("lanelet", lanelets_[goal.index].lanelet.id))) +
      "</planningProblem>\n";
}

void Scenario::count_heights(ExportNotes& notes) const {
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

// Letters and digits of the map's name, as the benchmark id wants them.
std::string map_name(const std::filesystem::path& map) {
  std::string name;
  for (const char c : map.stem().string())
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  if (name.empty()) return "Map";
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

std::string location(const std::optional<GeoOrigin>& origin, const ToDegrees* to_degrees) {
  // CommonRoad's own numbers for a place that is not known.
  if (!origin)
    return element("location", element("geoNameId", "-999") + element("gpsLatitude", "999") +
                                   element("gpsLongitude", "999"));
  return element(
      "location",
      element("geoNameId", "-999") + element("gpsLatitude", fixed_text(origin->latitude_deg, 9)) +
          element("gpsLongitude", fixed_text(origin->longitude_deg, 9)) +
          element("geoTransformation",
                  element("geoReference", to_degrees->projection()) +
                      element("additionalTransformation",
                              element("xTranslation", "0.0") + element("yTranslation", "0.0") +
                                  element("zRotation", "0.0") + element("scaling", "1.0"))));
}

}  // namespace

const std::vector<std::string>& commonroad_countries() {
  static const std::vector<std::string> countries = [] {
    std::vector<std::string> names;
    for (const auto& [country, sign] : speed_signs()) names.push_back(country);
    return names;
  }();
  return countries;
}

Paths export_commonroad(const std::filesystem::path& map,
                        const std::filesystem::path& out,
                        const ExportOptions& options,
                        ExportNotes& notes) {
  const PlannerMap planner(map);
  const auto origin = find_origin(map, options);
  const GdalScope scope;
  std::optional<ToDegrees> to_degrees;
  if (origin) to_degrees.emplace(*origin);
  const ToDegrees* const turned = to_degrees ? &*to_degrees : nullptr;
  const auto sign = std::find_if(speed_signs().begin(), speed_signs().end(),
                                 [&](const auto& s) { return s.first == options.country; });
  Scenario scenario(planner, turned, sign->second);
  if (scenario.empty())
    throw BadInput(
        Problem{Severity::kError, map.string(), 0, "lanes", "none with a path", "one and more"});
  scenario.add_roads();
  scenario.add_crossings(notes);
  scenario.add_parking(notes);
  scenario.add_intersections();
  scenario.add_problem();
  scenario.count_heights(notes);
  add_note(notes, "labels of other classes", planner.other_labels(),
           "CommonRoad has no place for them; --format gpkg has");
  const std::string date = planner.stored().source.date_utc.substr(0, 10);
  write_text_file(
      out,
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<commonRoad commonRoadVersion=\"2020a\" "
      "benchmarkID=\"" +
          options.country + "_" + map_name(map) + "-1_1\" date=\"" +
          (date.size() == 10 ? date : "1970-01-01") +
          "\" author=\"roadbook\" affiliation=\"none\" source=\"roadbook map " +
          planner.stored().digest + "\" timeStepSize=\"0.1\">\n  " + location(origin, turned) +
          "\n  <scenarioTags><urban/><speed_limit/>" +
          (scenario.has_turns() ? "<intersection/>" : "") + "</scenarioTags>\n" + scenario.text() +
          "</commonRoad>\n");
  return {out};
}

}  // namespace roadbook
