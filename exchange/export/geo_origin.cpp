#include "exchange/export/geo_origin.hpp"

#include <ogr_spatialref.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/text.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {
namespace {

// The fewest digits that give the same number back.
std::string degrees_text(double degrees) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.begin(), text.end(), degrees).ptr};
}

}  // namespace

void ToDegrees::Destroy::operator()(OGRCoordinateTransformation* t) const {
  OGRCoordinateTransformation::DestroyCT(t);
}

ToDegrees::ToDegrees(const GeoOrigin& origin)
    : origin_(origin),
      turn_rad_(origin.x_axis_deg * std::numbers::pi / 180.0),
      projection_("+proj=aeqd +lat_0=" + degrees_text(origin.latitude_deg) + " +lon_0=" +
                  degrees_text(origin.longitude_deg) + " +datum=WGS84 +units=m +no_defs") {
  OGRSpatialReference from;
  OGRSpatialReference to;
  ROADBOOK_ASSERT(from.importFromProj4(projection_.c_str()) == OGRERR_NONE);
  ROADBOOK_ASSERT(to.importFromEPSG(4326) == OGRERR_NONE);
  to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  transformation_.reset(OGRCreateCoordinateTransformation(&from, &to));
  back_.reset(OGRCreateCoordinateTransformation(&to, &from));
  ROADBOOK_ASSERT(transformation_ != nullptr && back_ != nullptr);
}

ToDegrees::~ToDegrees() = default;

Eigen::Vector2d ToDegrees::east_north(const Eigen::Vector2d& p) const {
  return {std::cos(turn_rad_) * p.x() - std::sin(turn_rad_) * p.y(),
          std::sin(turn_rad_) * p.x() + std::cos(turn_rad_) * p.y()};
}

Eigen::Vector2d ToDegrees::operator()(const Eigen::Vector2d& p) const {
  Eigen::Vector2d q = east_north(p);
  ROADBOOK_ASSERT(transformation_->Transform(1, &q.x(), &q.y()) == TRUE);
  return q;
}

std::optional<Eigen::Vector2d> ToDegrees::inverse(const Eigen::Vector2d& degrees) const {
  // Longitudes of what crosses the meridian of 180 degrees may run on beyond it.
  if (!(std::abs(degrees.x()) <= 360.0 && std::abs(degrees.y()) <= 90.0)) return std::nullopt;
  Eigen::Vector2d q = degrees;
  if (back_->Transform(1, &q.x(), &q.y()) != TRUE) return std::nullopt;
  return Eigen::Vector2d(std::cos(turn_rad_) * q.x() + std::sin(turn_rad_) * q.y(),
                         -std::sin(turn_rad_) * q.x() + std::cos(turn_rad_) * q.y());
}

std::optional<GeoOrigin> find_origin(const std::filesystem::path& map,
                                     const ExportOptions& options) {
  std::optional<GeoOrigin> origin = options.origin;
  if (!origin) {
    const MapMeta meta = load_meta(map);
    const auto number = [&](const char* key) -> std::optional<double> {
      const auto entry = meta.values.find(key);
      return entry == meta.values.end() ? std::nullopt : parse_double(entry->second);
    };
    const auto latitude = number("origin_latitude_deg");
    const auto longitude = number("origin_longitude_deg");
    if (latitude && longitude)
      origin = GeoOrigin{*latitude, *longitude, number("origin_x_axis_deg").value_or(0.0)};
  }
  if (origin) origin->check();
  return origin;
}

std::unique_ptr<const ToDegrees> find_to_degrees(const std::filesystem::path& map,
                                                 const ExportOptions& options) {
  const auto origin = find_origin(map, options);
  return origin ? std::make_unique<const ToDegrees>(*origin) : nullptr;
}

GeoOrigin require_origin(const std::filesystem::path& map,
                         const ExportOptions& options,
                         const std::string& reason) {
  const auto origin = find_origin(map, options);
  if (!origin)
    throw BadInput(Problem{Severity::kError, map.string(), 0, "origin", "none",
                           "latitude and longitude of the map's origin: " + reason});
  return *origin;
}

}  // namespace roadbook
