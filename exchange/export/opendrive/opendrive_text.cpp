#include "exchange/export/opendrive/opendrive_text.hpp"

#include <cmath>
#include <limits>

#include "exchange/export/xml_elements.hpp"
#include "exchange/layers/stored_paths.hpp"

namespace roadbook {
namespace {

std::string decimals9(double value) { return fixed_text(value, 9); }

void append_user_data(pugi::xml_node parent, const char* code, const std::string& value) {
  append_element(parent, "userData", {{"code", code}, {"value", value}});
}

// Where coordinates are written: the map's own, or east and north of the origin.
class Frame {
 public:
  explicit Frame(const ToDegrees* to_degrees) : to_degrees_(to_degrees) {
    if (to_degrees == nullptr) return;
    const Eigen::Vector2d x = to_degrees->east_north({1.0, 0.0});
    turn_rad_ = std::atan2(x.y(), x.x());
  }
  [[nodiscard]] Eigen::Vector2d point(double x, double y) const {
    return to_degrees_ == nullptr ? Eigen::Vector2d(x, y) : to_degrees_->east_north({x, y});
  }
  [[nodiscard]] double heading(double map_heading) const {
    return std::remainder(map_heading + turn_rad_, 2.0 * std::acos(-1.0));
  }
  void append_reference(pugi::xml_node header) const {
    if (to_degrees_ == nullptr) return;
    append_line(header, "geoReference")
        .append_child(pugi::node_cdata)
        .set_value(to_degrees_->projection().c_str());
  }

 private:
  const ToDegrees* to_degrees_;
  double turn_rad_ = 0.0;
};

struct Box {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector2d high = Eigen::Vector2d::Constant(std::numeric_limits<double>::lowest());
  void add(const Eigen::Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

void append_coefficients(pugi::xml_node node, const double* c, const char* suffix) {
  for (int k = 0; k < 4; ++k)
    node.append_attribute((std::string(1, "abcd"[k]) + suffix).c_str())
        .set_value(fixed_text(c[k], k < 2 ? 9 : 12).c_str());
}

void append_geometry(pugi::xml_node road,
                     const std::vector<DriveCubic>& cubics,
                     const Frame& frame,
                     Box& box) {
  const auto plan = append_line(road, "planView");
  const auto elevation = append_line(road, "elevationProfile");
  for (const DriveCubic& c : cubics) {
    const Eigen::Vector2d p = frame.point(c.x, c.y);
    box.add(p);
    const auto geometry = append_line(plan, "geometry",
                                      {{"s", decimals9(c.s_m)},
                                       {"x", decimals9(p.x())},
                                       {"y", decimals9(p.y())},
                                       {"hdg", decimals9(frame.heading(c.heading))},
                                       {"length", decimals9(c.length_m)}});
    auto cubic = append_element(geometry, "paramPoly3");
    append_coefficients(cubic, c.u, "U");
    append_coefficients(cubic, c.v, "V");
    cubic.append_attribute("pRange").set_value("arcLength");
    append_coefficients(append_line(elevation, "elevation", {{"s", decimals9(c.s_m)}}), c.z, "");
  }
}

void append_lane_link(pugi::xml_node lane, const DriveRoad& road) {
  const bool before = road.before.junction < 0 && road.before.road >= 0;
  const bool after = road.after.junction < 0 && road.after.road >= 0;
  if (!before && !after) return;
  const auto link = append_element(lane, "link");
  if (before) append_element(link, "predecessor", {{"id", "-1"}});
  if (after) append_element(link, "successor", {{"id", "-1"}});
}

// The one lane lies in the middle of its road.
void append_lanes(pugi::xml_node parent, const DriveRoad& road) {
  const auto lanes = append_line(parent, "lanes");
  append_line(
      lanes, "laneOffset",
      {{"s", "0"}, {"a", decimals9(0.5 * road.width_m)}, {"b", "0"}, {"c", "0"}, {"d", "0"}});
  const auto section = append_line(lanes, "laneSection", {{"s", "0"}});
  append_element(append_line(section, "center"), "lane",
                 {{"id", "0"}, {"type", "none"}, {"level", "false"}});
  const auto lane = append_element(append_line(section, "right"), "lane",
                                   {{"id", "-1"}, {"type", "driving"}, {"level", "false"}});
  append_lane_link(lane, road);
  append_element(
      lane, "width",
      {{"sOffset", "0"}, {"a", decimals9(road.width_m)}, {"b", "0"}, {"c", "0"}, {"d", "0"}});
  for (const SpeedPiece& piece : road.speeds)
    append_element(lane, "speed",
                   {{"sOffset", decimals9(piece.begin_m - road.begin_m)},
                    {"max", fixed_text(piece.speed, 4)},
                    {"unit", "m/s"}});
}

void append_outline(pugi::xml_node parent, const DriveObject& object) {
  const auto outline = append_element(append_element(parent, "outlines"), "outline",
                                      {{"id", "0"}, {"outer", "true"}, {"closed", "true"}});
  int id = 0;
  for (const Eigen::Vector3d& c : object.outline)
    append_element(outline, "cornerLocal",
                   {{"id", std::to_string(id++)},
                    {"u", fixed_text(c.x(), 6)},
                    {"v", fixed_text(c.y(), 6)},
                    {"z", fixed_text(c.z(), 6)},
                    {"height", "0"}});
}

class Writer {
 public:
  Writer(const PlannerMap& planner,
         const DriveRoads& roads,
         const DriveObjects& objects,
         const Frame& frame)
      : planner_(planner), roads_(roads), objects_(objects), frame_(frame) {}

  std::string text() {
    const auto root = append_element(document_, "OpenDRIVE");
    const auto header = append_line(root, "header");
    for (std::size_t i = 0; i < roads_.roads.size(); ++i) append_road(root, i);
    for (std::size_t i = 0; i < roads_.junctions.size(); ++i) append_junction(root, i);
    fill(header);
    return xml_text(document_);
  }

 private:
  // The header states the bounds of what was written.
  void fill(pugi::xml_node header) const {
    const StoredPaths& stored = planner_.stored();
    add_attributes(header, {{"revMajor", "1"},
                            {"revMinor", "6"},
                            {"name", "roadbook"},
                            {"version", "1"},
                            {"date", stored.source.date_utc},
                            {"north", fixed_text(box_.high.y(), 3)},
                            {"south", fixed_text(box_.low.y(), 3)},
                            {"east", fixed_text(box_.high.x(), 3)},
                            {"west", fixed_text(box_.low.x(), 3)}});
    frame_.append_reference(header);
    const auto append_data = [&](const char* code, const std::string& value) {
      append_line(header, "userData", {{"code", code}, {"value", value}});
    };
    append_data("map_digest", stored.digest);
    if (!std::isnan(stored.source.sigma_m))
      append_data("sigma_m", fixed_text(stored.source.sigma_m, 4));
    append_data("speeds", planner_.speeds_known() ? "map" : "bends and default limit");
  }

  // Roads count from 1, junctions on after them.
  static std::string road_id(int number) { return std::to_string(number + 1); }
  [[nodiscard]] std::string junction_id(int number) const {
    return std::to_string(roads_.roads.size() + static_cast<std::size_t>(number) + 1);
  }

  void append_link(pugi::xml_node link, const char* what, const DriveRoadEnd& end) const {
    if (end.junction >= 0)
      append_element(link, what,
                     {{"elementType", "junction"}, {"elementId", junction_id(end.junction)}});
    else if (end.road >= 0)
      append_element(link, what,
                     {{"elementType", "road"},
                      {"elementId", road_id(end.road)},
                      {"contactPoint", what == std::string("predecessor") ? "end" : "start"}});
  }

  void append_road(pugi::xml_node root, std::size_t index) {
    const DriveRoad& road = roads_.roads[index];
    const RoadObjects& beside = objects_.of_road[index];
    const auto node =
        append_line(root, "road",
                    {{"name", name_of(planner_, road)},
                     {"length", decimals9(road.length_m())},
                     {"id", road_id(static_cast<int>(index))},
                     {"junction", road.junction < 0 ? "-1" : junction_id(road.junction)},
                     {"rule", "RHT"}});
    const auto link = append_line(node, "link");
    append_link(link, "predecessor", road.before);
    append_link(link, "successor", road.after);
    append_geometry(node, drive_cubics(road.curve, road.begin_m, road.end_m, beside.stretches),
                    frame_, box_);
    append_lanes(node, road);
    append_objects(node, beside);
    append_origin(node, road);
  }

  // The lane of the map, and its part, that a road describes.
  void append_origin(pugi::xml_node node, const DriveRoad& road) const {
    if (road.piece < 0) return;
    const LanePiece& piece = planner_.layout().pieces[static_cast<std::size_t>(road.piece)];
    const bool against = road.backward != piece.turned;
    const double length = road.curve.length_m();
    const auto lane_place = [&](double s_m) {
      const double s = against ? length - s_m : s_m;
      return fixed_text(road.curve.closed() ? s - length * std::floor(s / length) : s, 6);
    };
    break_line(node);
    append_user_data(node, "lane", std::to_string(piece.id));
    append_user_data(node, "lane_direction", against ? "backward" : "forward");
    append_user_data(node, "lane_s_begin_m", lane_place(road.begin_m));
    append_user_data(node, "lane_s_end_m", lane_place(road.end_m));
  }

  void append_objects(pugi::xml_node road, const RoadObjects& beside) const {
    if (beside.objects.empty()) return;
    const auto objects = append_line(road, "objects");
    for (const DriveObject& o : beside.objects) {
      const auto object = append_line(objects, "object",
                                      {{"id", o.id},
                                       {"type", o.crossing ? "crosswalk" : "parkingSpace"},
                                       {"name", o.id},
                                       {"s", decimals9(o.s_m)},
                                       {"t", decimals9(o.t_m)},
                                       {"zOffset", fixed_text(o.z_m, 4)},
                                       {"hdg", decimals9(o.turn_rad)},
                                       {"pitch", "0"},
                                       {"roll", "0"},
                                       {"orientation", "none"},
                                       {"dynamic", "no"},
                                       {"length", fixed_text(o.length_m, 6)},
                                       {"width", fixed_text(o.width_m, 6)},
                                       {"height", "0"}});
      append_outline(object, o);
      if (!o.crossing) append_element(object, "parkingSpace", {{"access", "all"}});
      if (o.link != nullptr) append_lane_of(object, *o.link);
    }
  }

  // The lane that a space is entered from: `lane_s_m` along its path in the map.
  void append_lane_of(pugi::xml_node object, const SpaceLink& link) const {
    const LanePiece& piece = planner_.layout().pieces[static_cast<std::size_t>(link.piece)];
    const double s = piece.turned ? piece.curve.length_m() - link.s_m : link.s_m;
    append_user_data(object, "lane", std::to_string(link.lane));
    append_user_data(object, "lane_s_m", fixed_text(s, 6));
    append_user_data(object, "lane_side", link.left != piece.turned ? "left" : "right");
    append_user_data(object, "lane_distance_m", fixed_text(link.distance_m, 4));
  }

  void append_junction(pugi::xml_node root, std::size_t index) const {
    const DriveJunction& junction = roads_.junctions[index];
    const auto& crossing =
        planner_.stored().network.intersections[static_cast<std::size_t>(junction.intersection)];
    const auto node = append_line(root, "junction",
                                  {{"name", "intersection " + std::to_string(crossing.id)},
                                   {"id", junction_id(static_cast<int>(index))}});
    int count = 0;
    for (const int turn : junction.turns) {
      const int incoming = roads_.roads[static_cast<std::size_t>(turn)].before.road;
      append_element(append_line(node, "connection",
                                 {{"id", std::to_string(count++)},
                                  {"incomingRoad", road_id(incoming)},
                                  {"connectingRoad", road_id(turn)},
                                  {"contactPoint", "start"}}),
                     "laneLink", {{"from", "-1"}, {"to", "-1"}});
    }
  }

  pugi::xml_document document_;
  const PlannerMap& planner_;
  const DriveRoads& roads_;
  const DriveObjects& objects_;
  const Frame& frame_;
  Box box_;
};

}  // namespace

std::string opendrive_text(const PlannerMap& planner,
                           const DriveRoads& roads,
                           const DriveObjects& objects,
                           const ToDegrees* to_degrees) {
  const Frame frame(to_degrees);
  return Writer(planner, roads, objects, frame).text();
}

}  // namespace roadbook
