#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exchange/export/nav2/vehicle_footprint.hpp"

namespace roadbook {

/// Where the map frame lies on the earth. Degrees: this is where they enter and leave.
struct GeoOrigin {
  double latitude_deg = 0.0;  ///< of the map's origin, WGS84
  double longitude_deg = 0.0;
  double x_axis_deg = 0.0;  ///< direction of the map's x axis, counter-clockwise from east

  /// Throws InvalidOption.
  void check() const;
};

struct ExportOptions {
  /// For geojson, lanelet2, opendrive, commonroad; without it the map's own (`map_meta`:
  /// `origin_latitude_deg`, `origin_longitude_deg`, `origin_x_axis_deg`) is taken.
  std::optional<GeoOrigin> origin{};
  /// Layers to write (geojson, gpkg: vector; geotiff: raster); empty: all, of geojson without
  /// `landmark_points`.
  std::vector<std::string> layers{};
  double step_m = 0.5;  ///< path: between the rows of a lane
  /// path: the route from the first to the second place [m, map frame] instead of all lanes.
  std::optional<std::pair<Eigen::Vector3d, Eigen::Vector3d>> route{};

  std::string lane{};                 ///< spm: the id of the lane to write; empty: all
  std::string property = "friction";  ///< spm: which of the property map's

  double resolution_m = 0.1;  ///< nav2: side of a cell
  /// nav2: the vehicle for which lanes and ways into spaces are kept free; empty: a car, or the
  /// vehicles of the map where they are larger (`footprint_for`).
  std::optional<VehicleFootprint> vehicle{};

  /// lanelet2: `lanelet2` (rules of the library itself) or `autoware` (with its extensions).
  std::string profile = "lanelet2";
  /// commonroad: country whose traffic signs are used, three letters (`commonroad_countries`).
  std::string country = "ZAM";

  /// Throws InvalidOption.
  void check() const;
};

/// Profiles of format lanelet2.
[[nodiscard]] const std::vector<std::string>& lanelet2_profiles();
/// Countries of format commonroad: those whose sign of a speed limit its schema knows. ZAM is
/// CommonRoad's own, for maps of no country in particular.
[[nodiscard]] const std::vector<std::string>& commonroad_countries();

}  // namespace roadbook
