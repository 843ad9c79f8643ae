#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "exchange/export/export_map.hpp"

class OGRCoordinateTransformation;

namespace roadbook {

/// Converts the map frame to WGS84: rotation to east and north, then by PROJ from an azimuthal
/// equidistant projection about the origin, which preserves distance and direction from the origin.
class ToDegrees {
 public:
  explicit ToDegrees(const GeoOrigin& origin);
  ~ToDegrees();
  ToDegrees(const ToDegrees&) = delete;
  ToDegrees& operator=(const ToDegrees&) = delete;

  /// Longitude, latitude [degrees] of a point of the map [m].
  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& p) const;
  /// The point of the map [m] at longitude, latitude [degrees]; empty for values outside their
  /// range.
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

/// Returns the origin of the options, or else the one stored in the map (`map_meta`), after a
/// check; empty if there is neither.
[[nodiscard]] std::optional<GeoOrigin> find_origin(const std::filesystem::path& map,
                                                   const ExportOptions& options);
/// The transformation for that origin, to be used within a GdalScope; null where there is no
/// origin.
[[nodiscard]] std::unique_ptr<const ToDegrees> find_to_degrees(const std::filesystem::path& map,
                                                               const ExportOptions& options);
/// The same. Throws BadInput if there is no origin; `reason`: why it is needed, for the message.
[[nodiscard]] GeoOrigin require_origin(const std::filesystem::path& map,
                                       const ExportOptions& options,
                                       const std::string& reason);

}  // namespace roadbook
