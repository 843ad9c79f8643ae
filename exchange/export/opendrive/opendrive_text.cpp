#include "exchange/export/opendrive/opendrive_text.hpp"

#include <cmath>
#include <limits>

#include "exchange/layers/stored_paths.hpp"

namespace roadbook {
namespace {

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

std::string attribute(const char* name, double value, int decimals = 9) {
  return attribute(name, fixed_text(value, decimals));
}

std::string user_data(const char* code, const std::string& value) {
  return "<userData" + attribute("code", code) + attribute("value", value) + "/>";
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
  [[nodiscard]] std::string reference() const {
    return to_degrees_ == nullptr
               ? ""
               : "    <geoReference><![CDATA[" + to_degrees_->projection() + "]]></geoReference>\n";
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

std::string coefficients(const double* c, const char* suffix) {
  std::string text;
  for (int k = 0; k < 4; ++k) {
    const std::string name = std::string(1, "abcd"[k]) + suffix;
    text += attribute(name.c_str(), c[k], k < 2 ? 9 : 12);
  }
  return text;
}

std::string geometry(const std::vector<DriveCubic>& cubics, const Frame& frame, Box& box) {
  std::string plan = "    <planView>\n";
  std::string elevation = "    <elevationProfile>\n";
  for (const DriveCubic& c : cubics) {
    const Eigen::Vector2d p = frame.point(c.x, c.y);
    box.add(p);
    plan += "      <geometry" + attribute("s", c.s_m) + attribute("x", p.x()) +
            attribute("y", p.y()) + attribute("hdg", frame.heading(c.heading)) +
            attribute("length", c.length_m) + "><paramPoly3" + coefficients(c.u, "U") +
            coefficients(c.v, "V") + attribute("pRange", "arcLength") + "/></geometry>\n";
    elevation += "      <elevation" + attribute("s", c.s_m) + coefficients(c.z, "") + "/>\n";
  }
  return plan + "    </planView>\n" + elevation + "    </elevationProfile>\n";
}

// The one lane lies in the middle of its road.
std::string lanes(const DriveRoad& road, const std::string& link) {
  std::string speeds;
  for (const SpeedPiece& piece : road.speeds)
    speeds += "<speed" + attribute("sOffset", piece.begin_m - road.begin_m) +
              attribute("max", piece.speed, 4) + attribute("unit", "m/s") + "/>";
  return "    <lanes>\n      <laneOffset s=\"0\"" + attribute("a", 0.5 * road.width_m) +
         " b=\"0\" c=\"0\" d=\"0\"/>\n      <laneSection s=\"0\">\n        <center><lane id=\"0\" "
         "type=\"none\" level=\"false\"/></center>\n        <right><lane id=\"-1\" "
         "type=\"driving\" level=\"false\">" +
         link + "<width sOffset=\"0\"" + attribute("a", road.width_m) +
         " b=\"0\" c=\"0\" d=\"0\"/>" + speeds +
         "</lane></right>\n      </laneSection>\n    </lanes>\n";
}

std::string outline(const DriveObject& object) {
  std::string text = "<outlines><outline id=\"0\" outer=\"true\" closed=\"true\">";
  int id = 0;
  for (const Eigen::Vector3d& c : object.outline)
    text += "<cornerLocal" + attribute("id", std::to_string(id++)) + attribute("u", c.x(), 6) +
            attribute("v", c.y(), 6) + attribute("z", c.z(), 6) + " height=\"0\"/>";
  return text + "</outline></outlines>";
}

class Writer {
 public:
  Writer(const PlannerMap& planner,
         const DriveRoads& roads,
         const DriveObjects& objects,
         const Frame& frame)
      : planner_(planner), roads_(roads), objects_(objects), frame_(frame) {}

  std::string text() {
    std::string body;
    for (std::size_t i = 0; i < roads_.roads.size(); ++i) body += road(i);
    for (std::size_t i = 0; i < roads_.junctions.size(); ++i) body += junction(i);
    return header() + body + "</OpenDRIVE>\n";
  }

 private:
  [[nodiscard]] std::string header() const {
    const StoredPaths& stored = planner_.stored();
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<OpenDRIVE>\n  <header revMajor=\"1\" "
           "revMinor=\"6\" name=\"roadbook\" version=\"1\"" +
           attribute("date", stored.source.date_utc) + attribute("north", box_.high.y(), 3) +
           attribute("south", box_.low.y(), 3) + attribute("east", box_.high.x(), 3) +
           attribute("west", box_.low.x(), 3) + ">\n" + frame_.reference() + "    " +
           user_data("map_digest", stored.digest) + "\n    " +
           user_data("sigma_m", fixed_text(stored.source.sigma_m, 4)) + "\n    " +
           user_data("speeds", planner_.speeds_known() ? "map" : "bends and default limit") +
           "\n  </header>\n";
  }

  // Roads count from 1, junctions on after them.
  static std::string road_id(int number) { return std::to_string(number + 1); }
  [[nodiscard]] std::string junction_id(int number) const {
    return std::to_string(roads_.roads.size() + static_cast<std::size_t>(number) + 1);
  }

  [[nodiscard]] std::string link(const char* what, const DriveRoadEnd& end) const {
    const std::string begin = std::string("<") + what;
    if (end.junction >= 0)
      return begin + " elementType=\"junction\"" +
             attribute("elementId", junction_id(end.junction)) + "/>";
    if (end.road < 0) return "";
    return begin + " elementType=\"road\"" + attribute("elementId", road_id(end.road)) +
           attribute("contactPoint", what == std::string("predecessor") ? "end" : "start") + "/>";
  }

  static std::string lane_link(const DriveRoad& road) {
    std::string text;
    if (road.before.junction < 0 && road.before.road >= 0) text += "<predecessor id=\"-1\"/>";
    if (road.after.junction < 0 && road.after.road >= 0) text += "<successor id=\"-1\"/>";
    return text.empty() ? "" : "<link>" + text + "</link>";
  }

  std::string road(std::size_t index) {
    const DriveRoad& road = roads_.roads[index];
    const RoadObjects& beside = objects_.of_road[index];
    return "  <road" + attribute("name", name_of(planner_, road)) +
           attribute("length", road.length_m()) +
           attribute("id", road_id(static_cast<int>(index))) +
           attribute("junction", road.junction < 0 ? "-1" : junction_id(road.junction)) +
           " rule=\"RHT\">\n    <link>" + link("predecessor", road.before) +
           link("successor", road.after) + "</link>\n" +
           geometry(drive_cubics(road.curve, road.begin_m, road.end_m, beside.stretches), frame_,
                    box_) +
           lanes(road, lane_link(road)) + objects(beside) + origin_of(road) + "  </road>\n";
  }

  // The lane of the map, and its part, that a road describes.
  [[nodiscard]] std::string origin_of(const DriveRoad& road) const {
    if (road.piece < 0) return "";
    const LanePiece& piece = planner_.layout().pieces[static_cast<std::size_t>(road.piece)];
    const bool against = road.backward != piece.turned;
    const double length = road.curve.length_m();
    const auto lane_place = [&](double s_m) {
      const double s = against ? length - s_m : s_m;
      return fixed_text(road.curve.closed() ? s - length * std::floor(s / length) : s, 6);
    };
    return "    " + user_data("lane", std::to_string(piece.id)) +
           user_data("lane_direction", against ? "backward" : "forward") +
           user_data("lane_s_begin_m", lane_place(road.begin_m)) +
           user_data("lane_s_end_m", lane_place(road.end_m)) + "\n";
  }

  [[nodiscard]] std::string objects(const RoadObjects& beside) const {
    if (beside.objects.empty()) return "";
    std::string text = "    <objects>\n";
    for (const DriveObject& o : beside.objects)
      text += "      <object" + attribute("id", o.id) +
              attribute("type", o.crossing ? "crosswalk" : "parkingSpace") +
              attribute("name", o.id) + attribute("s", o.s_m) + attribute("t", o.t_m) +
              attribute("zOffset", o.z_m, 4) + attribute("hdg", o.turn_rad) +
              " pitch=\"0\" roll=\"0\" orientation=\"none\" dynamic=\"no\"" +
              attribute("length", o.length_m, 6) + attribute("width", o.width_m, 6) +
              " height=\"0\">" + outline(o) + (o.crossing ? "" : "<parkingSpace access=\"all\"/>") +
              link_of(o) + "</object>\n";
    return text + "    </objects>\n";
  }

  // The lane that a space is entered from: `lane_s_m` along its path in the map.
  [[nodiscard]] std::string link_of(const DriveObject& object) const {
    if (object.link == nullptr) return "";
    const SpaceLink& link = *object.link;
    const LanePiece& piece = planner_.layout().pieces[static_cast<std::size_t>(link.piece)];
    const double s = piece.turned ? piece.curve.length_m() - link.s_m : link.s_m;
    return user_data("lane", std::to_string(link.lane)) + user_data("lane_s_m", fixed_text(s, 6)) +
           user_data("lane_side", link.left != piece.turned ? "left" : "right") +
           user_data("lane_distance_m", fixed_text(link.distance_m, 4));
  }

  [[nodiscard]] std::string junction(std::size_t index) const {
    const DriveJunction& junction = roads_.junctions[index];
    const auto& crossing =
        planner_.stored().network.intersections[static_cast<std::size_t>(junction.intersection)];
    std::string text = "  <junction" +
                       attribute("name", "intersection " + std::to_string(crossing.id)) +
                       attribute("id", junction_id(static_cast<int>(index))) + ">\n";
    int count = 0;
    for (const int turn : junction.turns)
      text += "    <connection" + attribute("id", std::to_string(count++)) +
              attribute("incomingRoad",
                        road_id(roads_.roads[static_cast<std::size_t>(turn)].before.road)) +
              attribute("connectingRoad", road_id(turn)) +
              " contactPoint=\"start\"><laneLink from=\"-1\" to=\"-1\"/></connection>\n";
    return text + "  </junction>\n";
  }

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
