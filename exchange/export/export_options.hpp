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
  /// For geojson, lanelet2, opendrive, commonroad. Empty: the origin stored in the map (`map_meta`:
  /// `origin_latitude_deg`, `origin_longitude_deg`, `origin_x_axis_deg`).
  std::optional<GeoOrigin> origin{};
  /// Layers to write (geojson, gpkg: vector; geotiff: raster; nav2: `occupancy` instead of the
  /// masks); empty: all, of geojson without `landmark_points`.
  std::vector<std::string> layers{};
  double step_m = 0.5;  ///< path: between the rows of a lane
  /// path: the route from the first to the second position [m, map frame] instead of all lanes.
  std::optional<std::pair<Eigen::Vector3d, Eigen::Vector3d>> route{};

  std::string lane{};                 ///< spm: the id of the lane to write; empty: all
  std::string property = "friction";  ///< spm: name of the property to write

  double resolution_m = 0.1;  ///< nav2: side of a cell
  /// nav2: the vehicle for which lanes and the ground between lanes and spaces are kept free.
  /// Empty: a car, enlarged to the vehicles of the map (`footprint_for`).
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
/// Countries of format commonroad: those with a speed-limit sign in its schema. ZAM is CommonRoad's
/// own code for maps without a country.
[[nodiscard]] const std::vector<std::string>& commonroad_countries();

}  // namespace roadbook
