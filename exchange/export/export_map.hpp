#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exchange/export/export_notes.hpp"
#include "exchange/export/nav2/vehicle_footprint.hpp"

namespace roadbook {

// Maps written in the formats of other programs.

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

/// Names of the formats `export_map` knows.
[[nodiscard]] const std::vector<std::string>& export_formats();

/// Writes `map` to `out` and returns the files written.
///
/// - `tum`: keyframe poses, one file a session: `out`, or `out` with `_SESSION` before its
/// extension
///   where there are several. Seconds are the integer stamps, all nine decimals.
/// - `geojson`: vector layers as one collection in WGS84; each feature names its `layer`. Where
///   `out` has no extension or is a folder: a file a layer in that folder.
/// - `coco`: labels as instances in the overhead image: JSON `out`, the image beside it (.png, and
///   .pgw, its place). `yolo`: the same as a folder `out` (data.yaml, images, labels), outlines in
///   shares of the image, cut at its edge. Rejections are left out, and what lies outside the image
///   (picture_edge.hpp); import_labels.hpp reads them back.
/// - `geotiff`: raster layers, one file each (`_LAYER` where there are several), tiled, with
/// overviews.
/// - `gpkg`: vector layers alone with their styles, for GIS programs.
/// - `qgis`: a QGIS project (.qgs, or .qgz: the same packed) that shows the layers of the map where
///   it lies, vectors over rasters.
/// - `path`: every lane over its arc length: s, x, y, z, heading, curvature, width; CSV, or JSON
///   where `out` ends in .json. With `route`, the way from place to place as one curve.
/// - `spm`: the friction map of each lane as a slice for a controller
/// (speedmap/property_map/slice.hpp): JSON, or
///   a C header where `out` ends in .h; one file a lane (`_LANE` where there are several).
/// - `nav2`: masks for Nav2's costmap filters, on one grid: `out`_keepout.pgm (nav2_keepout.hpp)
///   and, of a map with speeds, the speed mask `out`.pgm (nav2_speed.hpp), each with its .yaml and
///   the parameters of its filter in `_filter.yaml`.
/// - `lanelet2`: lanes and turns as lanelets with speed limits, crossings as crosswalks, parking
///   spaces as areas (profile autoware: as its parking spaces and lots), in an OSM file; needs the
///   origin.
/// - `commonroad`: the same as a CommonRoad scenario, XML 2020a, with a planning problem.
/// - `opendrive`: the same as roads and junctions, OpenDRIVE 1.6; in the map frame, or with the
///   origin in east and north of it with a geoReference.
///
/// What the format has no place for is added to `notes` where they are given.
///
/// Files appear whole or not at all. Throws InvalidOption for an unknown format (naming the
/// nearest), BadInput for a map that cannot be read, has nothing of the kind, or (geojson) no
/// origin; StorageError.
std::vector<std::filesystem::path> export_map(const std::filesystem::path& map,
                                              const std::string& format,
                                              const std::filesystem::path& out,
                                              const ExportOptions& options = {},
                                              ExportNotes* notes = nullptr);

}  // namespace roadbook
