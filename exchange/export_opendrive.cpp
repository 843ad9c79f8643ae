#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "exchange/export_formats.hpp"
#include "exchange/geo_origin.hpp"
#include "exchange/opendrive_geometry.hpp"
#include "exchange/output_file.hpp"
#include "exchange/stored_paths.hpp"
#include "mapping/map_layers_gdal.hpp"
#include "roadnet/lane_layout.hpp"

// OpenDRIVE 1.6: a road a lane, a junction an intersection, a connecting road a turn. The one lane
// of a road lies in its middle (laneOffset half a width) and is `driving`, or `bidirectional` where
// it was driven both ways: a narrow road's one lane for both, as the standard has it.

namespace roadbook {
namespace {

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

std::string attribute(const char* name, double value, int decimals = 9) {
  return attribute(name, fixed_text(value, decimals));
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

std::string lanes(double width_m, bool both_ways, const std::string& link) {
  return "    <lanes>\n      <laneOffset s=\"0\"" + attribute("a", 0.5 * width_m) +
         " b=\"0\" c=\"0\" d=\"0\"/>\n      <laneSection s=\"0\">\n        <center><lane id=\"0\" "
         "type=\"none\" level=\"false\"/></center>\n        <right><lane id=\"-1\"" +
         attribute("type", both_ways ? "bidirectional" : "driving") + " level=\"false\">" + link +
         "<width sOffset=\"0\"" + attribute("a", width_m) +
         " b=\"0\" c=\"0\" d=\"0\"/></lane></right>\n      </laneSection>\n    </lanes>\n";
}

std::string road(int id,
                 const std::string& name,
                 int junction,
                 const PathCurve& curve,
                 double begin_m,
                 double end_m,
                 const std::string& link,
                 const std::string& lane_part,
                 const Frame& frame,
                 Box& box) {
  return "  <road" + attribute("name", name) + attribute("length", end_m - begin_m) +
         attribute("id", std::to_string(id)) + attribute("junction", std::to_string(junction)) +
         " rule=\"RHT\">\n    <link>" + link + "</link>\n" +
         geometry(drive_cubics(curve, begin_m, end_m), frame, box) + lane_part + "  </road>\n";
}

const char* contact(bool at_end) { return at_end ? "end" : "start"; }

// Roads 1.. are the lanes in their order, the turns follow; junctions count on after them.
class Writer {
 public:
  Writer(const StoredPaths& stored, const LaneLayout& layout, const Frame& frame)
      : stored_(stored), layout_(layout), frame_(frame) {
    const int roads = static_cast<int>(layout.pieces.size() + layout.connectors.size());
    for (const Connector& turn : layout.connectors) {
      if (junction_.contains(turn.intersection)) continue;
      const int id = roads + 1 + static_cast<int>(junction_.size());
      junction_[turn.intersection] = id;
    }
    for (const Connector& turn : layout.connectors)
      for (const PieceEnd& end : {turn.from, turn.to})
        junction_at_[{end.piece, end.at_end}] = junction_.at(turn.intersection);
  }

  std::string text() {
    std::string body;
    for (std::size_t i = 0; i < layout_.pieces.size(); ++i) body += lane_road(static_cast<int>(i));
    for (std::size_t i = 0; i < layout_.connectors.size(); ++i)
      body += turn_road(static_cast<int>(i));
    for (const auto& [intersection, id] : junction_) body += junction(intersection, id);
    return header() + body + "</OpenDRIVE>\n";
  }

 private:
  [[nodiscard]] std::string header() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<OpenDRIVE>\n  <header revMajor=\"1\" "
           "revMinor=\"6\" name=\"roadbook\" version=\"1\"" +
           attribute("date", stored_.source.date_utc) + attribute("north", box_.high.y(), 3) +
           attribute("south", box_.low.y(), 3) + attribute("east", box_.high.x(), 3) +
           attribute("west", box_.low.x(), 3) + ">\n" + frame_.reference() +
           "    <userData code=\"map_digest\"" + attribute("value", stored_.digest) +
           "/>\n    <userData code=\"sigma_m\"" + attribute("value", stored_.source.sigma_m, 4) +
           "/>\n  </header>\n";
  }

  std::string lane_road(int index) {
    const LanePiece& piece = layout_.pieces[static_cast<std::size_t>(index)];
    std::string link;
    std::string lane_link;
    for (const bool at_end : {false, true}) {
      const char* const what = at_end ? "successor" : "predecessor";
      const auto found = junction_at_.find({index, at_end});
      if (found != junction_at_.end()) {
        link += std::string("<") + what + " elementType=\"junction\"" +
                attribute("elementId", std::to_string(found->second)) + "/>";
      } else if (piece.curve.closed()) {
        link += std::string("<") + what + " elementType=\"road\"" +
                attribute("elementId", std::to_string(index + 1)) +
                attribute("contactPoint", contact(!at_end)) + "/>";
        lane_link += std::string("<") + what + " id=\"-1\"/>";
      }
    }
    if (!lane_link.empty()) lane_link = "<link>" + lane_link + "</link>";
    return road(index + 1, "lane " + std::to_string(piece.id), -1, piece.curve, piece.s_begin_m,
                piece.s_end_m, link, lanes(piece.width_m, piece.both_ways, lane_link), frame_,
                box_);
  }

  std::string turn_road(int index) {
    const Connector& turn = layout_.connectors[static_cast<std::size_t>(index)];
    const auto neighbour = [](const char* what, const PieceEnd& end) {
      return std::string("<") + what + " elementType=\"road\"" +
             attribute("elementId", std::to_string(end.piece + 1)) +
             attribute("contactPoint", contact(end.at_end)) + "/>";
    };
    return road(turn_road_id(index), "turn " + std::to_string(index),
                junction_.at(turn.intersection), turn.curve, 0.0, turn.curve.length_m(),
                neighbour("predecessor", turn.from) + neighbour("successor", turn.to),
                lanes(turn.width_m, turn.both_ways,
                      "<link><predecessor id=\"-1\"/><successor id=\"-1\"/></link>"),
                frame_, box_);
  }

  [[nodiscard]] int turn_road_id(int index) const {
    return static_cast<int>(layout_.pieces.size()) + 1 + index;
  }

  [[nodiscard]] std::string junction(int intersection, int id) const {
    std::string text =
        "  <junction" +
        attribute(
            "name",
            "intersection " +
                std::to_string(
                    stored_.network.intersections[static_cast<std::size_t>(intersection)].id)) +
        attribute("id", std::to_string(id)) + ">\n";
    int count = 0;
    for (std::size_t i = 0; i < layout_.connectors.size(); ++i) {
      const Connector& turn = layout_.connectors[i];
      if (turn.intersection != intersection) continue;
      const auto connection = [&](const PieceEnd& incoming, bool at_end) {
        text += "    <connection" + attribute("id", std::to_string(count++)) +
                attribute("incomingRoad", std::to_string(incoming.piece + 1)) +
                attribute("connectingRoad", std::to_string(turn_road_id(static_cast<int>(i)))) +
                attribute("contactPoint", contact(at_end)) +
                "><laneLink from=\"-1\" to=\"-1\"/></connection>\n";
      };
      connection(turn.from, false);
      if (turn.both_ways) connection(turn.to, true);
    }
    return text + "  </junction>\n";
  }

  const StoredPaths& stored_;
  const LaneLayout& layout_;
  const Frame& frame_;
  Box box_;
  std::map<int, int> junction_;                      // of an intersection
  std::map<std::pair<int, bool>, int> junction_at_;  // of a piece's end
};

}  // namespace

Paths export_opendrive(const std::filesystem::path& map,
                       const std::filesystem::path& out,
                       const ExportOptions& options) {
  const StoredPaths stored = load_paths(map);
  const auto origin = find_origin(map, options);
  const GdalScope scope;
  std::optional<ToDegrees> to_degrees;
  if (origin) to_degrees.emplace(*origin);
  const Frame frame(to_degrees ? &*to_degrees : nullptr);
  const LaneLayout layout = lay_out(stored.network, stored.paths);
  write_text_file(out, Writer(stored, layout, frame).text());
  return {out};
}

}  // namespace roadbook
