#include "exchange/import/geojson_geometry.hpp"

#include <ogr_geometry.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "exchange/import/json_fields.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

/// Longitude, latitude [degrees], height [m]. Longitudes of a line run on beyond 180 degrees.
using Line = std::vector<Eigen::Vector3d>;

constexpr double kHalfTurn = 180.0;
constexpr double kTurn = 360.0;
constexpr double kRounding = 3e-9;  // [degrees]: of the corners written

Line in_degrees(const std::vector<Eigen::Vector4d>& points, const ToDegrees& to_degrees) {
  Line line;
  for (const Eigen::Vector4d& p : points) {
    const Eigen::Vector2d degrees = to_degrees(p.head<2>());
    double longitude = degrees.x();
    if (!line.empty()) longitude += kTurn * std::round((line.back().x() - longitude) / kTurn);
    line.emplace_back(longitude, degrees.y(), p.z());
  }
  return line;
}

ordered_json coordinates(const Line& line, double turn) {
  const auto rounded = [](double value, double scale) { return std::round(value * scale) / scale; };
  ordered_json json = ordered_json::array();
  for (const Eigen::Vector3d& p : line)
    json.push_back({std::clamp(rounded(p.x() - turn, 1e9), -kHalfTurn, kHalfTurn),
                    rounded(p.y(), 1e9), rounded(p.z(), 1e4)});
  return json;
}

// The part of a geometry between two meridians half a turn to either side of `turn`.
std::unique_ptr<OGRGeometry> part_of(const OGRGeometry& geometry, double turn) {
  OGRLinearRing ring;
  const double west = turn - kHalfTurn;
  const double east = turn + kHalfTurn;
  for (const auto& [x, y] :
       {std::pair{west, -90.0}, {east, -90.0}, {east, 90.0}, {west, 90.0}, {west, -90.0}})
    ring.addPoint(x, y);
  OGRPolygon band;
  band.addRing(&ring);
  return std::unique_ptr<OGRGeometry>(geometry.Intersection(&band));
}

Line line_of(const OGRSimpleCurve& curve) {
  Line line;
  for (int i = 0; i < curve.getNumPoints(); ++i)
    line.emplace_back(curve.getX(i), curve.getY(i), curve.getZ(i));
  return line;
}

// Lines or outer rings of a geometry, single or in a collection.
void add_lines(const OGRGeometry& geometry, std::vector<Line>& lines) {
  const auto flat = wkbFlatten(geometry.getGeometryType());
  if (geometry.IsEmpty()) return;
  if (flat == wkbLineString) {
    lines.push_back(line_of(*geometry.toLineString()));
  } else if (flat == wkbPolygon) {
    lines.push_back(line_of(*geometry.toPolygon()->getExteriorRing()));
  } else if (OGR_GT_IsSubClassOf(geometry.getGeometryType(), wkbGeometryCollection)) {
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) add_lines(*part, lines);
  }
}

// A right-handed ring, as RFC 7946, section 3.1.6 requires.
Line counter_clockwise(Line ring) {
  double twice_area = 0.0;
  const double west = ring.front().x();  // near, for the digits
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    twice_area += (ring[j].x() - west) * ring[i].y() - (ring[i].x() - west) * ring[j].y();
  if (twice_area < 0.0) std::reverse(ring.begin(), ring.end());
  return ring;
}

std::unique_ptr<OGRGeometry> geometry_of(const Line& line, bool polygon) {
  OGRLinearRing ring;
  auto curve = std::make_unique<OGRLineString>();
  for (const Eigen::Vector3d& p : line)
    polygon ? ring.addPoint(p.x(), p.y(), p.z()) : curve->addPoint(p.x(), p.y(), p.z());
  if (!polygon) return curve;
  auto area = std::make_unique<OGRPolygon>();
  area->addRing(&ring);
  return area;
}

// Lines that stay on one side of the meridian of 180 degrees, each with its whole turns [degrees].
std::vector<std::pair<Line, double>> cut_at_antimeridian(const Line& line, bool polygon) {
  const auto [west, east] = std::minmax_element(
      line.begin(), line.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  if (west->x() >= -kHalfTurn && east->x() <= kHalfTurn) return {{line, 0.0}};
  std::vector<std::pair<Line, double>> parts;
  const auto whole = geometry_of(line, polygon);
  for (double turn = kTurn * std::round(west->x() / kTurn); turn - kHalfTurn < east->x();
       turn += kTurn) {
    std::vector<Line> lines;
    if (const auto part = part_of(*whole, turn)) add_lines(*part, lines);
    for (Line& one : lines) parts.emplace_back(std::move(one), turn);
  }
  return parts;
}

// A polygon of one ring of GeoJSON, longitudes from 0 to 360; null for any other geometry, and for
// a ring without a corner on the meridian of 180 degrees.
std::unique_ptr<OGRPolygon> polygon_east_of_greenwich(const nlohmann::json& rings) {
  if (!rings.is_array() || rings.size() != 1 || !rings[0].is_array()) return nullptr;
  OGRLinearRing ring;
  bool touches = false;
  for (const nlohmann::json& p : rings[0]) {
    if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number()) return nullptr;
    const double longitude = p[0];
    touches = touches || std::abs(std::abs(longitude) - kHalfTurn) < kRounding;
    ring.addPoint(longitude < 0.0 ? longitude + kTurn : longitude, p[1],
                  p.size() > 2 && p[2].is_number() ? p[2].get<double>() : 0.0);
  }
  if (!touches) return nullptr;
  auto polygon = std::make_unique<OGRPolygon>();
  polygon->addRing(&ring);
  return polygon;
}

// A corner on the meridian that lies on the line between its neighbours is the cut's.
bool is_made_by_the_cut(const Line& ring, std::size_t i) {
  const Eigen::Vector2d p = ring[i].head<2>();
  const Eigen::Vector2d from = ring[(i + ring.size() - 1) % ring.size()].head<2>();
  const Eigen::Vector2d along = (ring[(i + 1) % ring.size()].head<2>() - from).normalized();
  const Eigen::Vector2d to = p - from;
  return std::abs(p.x() - kHalfTurn) < kRounding &&
         std::abs(to.x() * along.y() - to.y() * along.x()) < kRounding;
}

}  // namespace

std::optional<std::string> foreign_reference(const nlohmann::json& crs) {
  static const std::set<std::string> known{"urn:ogc:def:crs:OGC:1.3:CRS84",
                                           "urn:ogc:def:crs:OGC:1.3:CRS84h",
                                           "urn:ogc:def:crs:OGC::CRS84",
                                           "OGC:CRS84",
                                           "urn:ogc:def:crs:EPSG::4326",
                                           "urn:ogc:def:crs:EPSG::4979",
                                           "EPSG:4326",
                                           "EPSG:4979"};
  if (crs.is_null()) return std::nullopt;
  const auto properties = crs.is_object() ? crs.value("properties", nlohmann::json()) : crs;
  const auto name =
      properties.is_object() ? properties.value("name", nlohmann::json()) : nlohmann::json();
  if (name.is_string() && known.contains(name.get<std::string>())) return std::nullopt;
  return name.is_string() ? name.get<std::string>() : shown(crs);
}

nlohmann::json joined_at_antimeridian(const nlohmann::json& coordinates) {
  if (!coordinates.is_array() || coordinates.empty()) return nullptr;
  std::unique_ptr<OGRGeometry> whole;
  for (const nlohmann::json& part : coordinates) {
    auto polygon = polygon_east_of_greenwich(part);
    if (!polygon) return nullptr;
    whole.reset(whole ? whole->Union(polygon.get()) : polygon.release());
    if (!whole) return nullptr;
  }
  if (wkbFlatten(whole->getGeometryType()) != wkbPolygon ||
      whole->toPolygon()->getNumInteriorRings() > 0)
    return nullptr;
  Line ring = line_of(*whole->toPolygon()->getExteriorRing());
  ring.pop_back();
  nlohmann::json corners = nlohmann::json::array();
  ring = counter_clockwise(std::move(ring));
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (!is_made_by_the_cut(ring, i)) corners.push_back({ring[i].x(), ring[i].y(), ring[i].z()});
  if (!corners.empty()) corners.push_back(corners.front());
  return corners;
}

ordered_json geojson_geometry(GeometryType type,
                              const std::vector<Eigen::Vector4d>& points,
                              const ToDegrees& to_degrees) {
  const Line line = in_degrees(points, to_degrees);
  const bool polygon = type == GeometryType::kPolygonZ;
  if (!polygon && type != GeometryType::kLineStringZ)
    return {{"type", "Point"},
            {"coordinates", line.empty() ? ordered_json::array() : coordinates(line, 0.0).front()}};
  const std::string name = polygon ? "Polygon" : "LineString";
  if (line.empty()) return {{"type", name}, {"coordinates", ordered_json::array()}};
  if (polygon && std::abs(line.back().x() - line.front().x()) > kHalfTurn) return nullptr;
  ordered_json parts = ordered_json::array();
  for (const auto& [part, turn] : cut_at_antimeridian(line, polygon))
    parts.push_back(polygon ? ordered_json::array({coordinates(counter_clockwise(part), turn)})
                            : coordinates(part, turn));
  if (parts.size() == 1) return {{"type", name}, {"coordinates", parts.front()}};
  return {{"type", "Multi" + name}, {"coordinates", parts}};
}

}  // namespace roadbook
