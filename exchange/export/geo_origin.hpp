#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "exchange/export/export_map.hpp"

class OGRCoordinateTransformation;

namespace roadbook {

/// Map frame to WGS84: turned to east and north, then by PROJ from an azimuthal equidistant
/// projection about the origin, which keeps distance and direction from there.
class ToDegrees {
 public:
  explicit ToDegrees(const GeoOrigin& origin);
  ~ToDegrees();
  ToDegrees(const ToDegrees&) = delete;
  ToDegrees& operator=(const ToDegrees&) = delete;

  /// Longitude, latitude [degrees] of a point of the map [m].
  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& p) const;
  /// The point of the map of longitude, latitude [degrees]; empty where these are no degrees.
  [[nodiscard]] std::optional<Eigen::Vector2d> inverse(const Eigen::Vector2d& degrees) const;
  /// East and north of the origin [m].
  [[nodiscard]] Eigen::Vector2d east_north(const Eigen::Vector2d& p) const;
  [[nodiscard]] const GeoOrigin& origin() const { return origin_; }
  /// The projection from east and north, as PROJ writes it.
  [[nodiscard]] const std::string& projection() const { return projection_; }

 private:
  struct Destroy {
    void operator()(OGRCoordinateTransformation* t) const;
  };
  GeoOrigin origin_;
  double turn_rad_;
  std::string projection_;
  std::unique_ptr<OGRCoordinateTransformation, Destroy> transformation_;
  std::unique_ptr<OGRCoordinateTransformation, Destroy> back_;
};

/// The origin given, or the map's own (`map_meta`), checked; empty where there is neither.
[[nodiscard]] std::optional<GeoOrigin> find_origin(const std::filesystem::path& map,
                                                   const ExportOptions& options);
/// The transformation for that origin, to be used within a GdalScope; null where there is no
/// origin.
[[nodiscard]] std::unique_ptr<const ToDegrees> find_to_degrees(const std::filesystem::path& map,
                                                               const ExportOptions& options);
/// The origin as `find_origin` finds it; BadInput where the map has no origin, with the reason why
/// the origin is needed.
[[nodiscard]] GeoOrigin require_origin(const std::filesystem::path& map,
                                       const ExportOptions& options,
                                       const std::string& reason);

}  // namespace roadbook
