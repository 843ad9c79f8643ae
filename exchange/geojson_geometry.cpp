#include "exchange/geojson_geometry.hpp"

#include <ogr_geometry.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace roadbook {
namespace {

using nlohmann::ordered_json;

/// Longitude, latitude [degrees], height [m]. Longitudes of a line run on beyond 180 degrees.
using Line = std::vector<Eigen::Vector3d>;

constexpr double kHalfTurn = 180.0;
constexpr double kTurn = 360.0;

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

// A right-handed ring, as section 3.1.6 wants.
Line counter_clockwise(Line ring) {
  double twice_area = 0.0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    twice_area += ring[i].x() * ring[i + 1].y() - ring[i + 1].x() * ring[i].y();
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

}  // namespace

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
