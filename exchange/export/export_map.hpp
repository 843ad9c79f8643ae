#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exchange/export/export_notes.hpp"
#include "exchange/export/export_options.hpp"

namespace roadbook {

// Export of maps to the formats of other programs.

/// Names of the formats `export_map` knows.
[[nodiscard]] const std::vector<std::string>& export_formats();

/// Writes `map` to `out` and returns the files written.
///
/// - `tum`: keyframe poses, one file for each session: `out`, or with several sessions `out` with
///   `_SESSION` before its extension. Times are the stamps in seconds with nine decimals.
/// - `geojson`: vector layers as one collection in WGS84; each feature names its `layer`. If `out`
///   has no extension or is a folder: one file for each layer in this folder.
/// - `coco`: labels as instances in the overhead image: JSON file `out`, the image (.png) and its
///   position (.pgw). `yolo`: the same as a folder `out` (data.yaml, images, labels), with outlines
///   in shares of the image, cut at its edge. Both leave out rejected hypotheses, and labels
///   outside the image (picture_edge.hpp). import_labels.hpp reads them back.
/// - `geotiff`: raster layers, one file each (`_LAYER` if there are several), tiled, with
/// overviews.
/// - `gpkg`: only the vector layers with their styles, for GIS programs.
/// - `qgis`: a QGIS project (.qgs, or .qgz: compressed) that shows the layers of the map file
/// itself,
///   vectors over rasters.
/// - `path`: every lane over its arc length: s, x, y, z, heading, curvature, width. CSV, or JSON if
///   `out` ends in .json. With `route`, one curve from position to position.
/// - `spm`: the friction map of each lane as a slice for a controller
///   (speedmap/property_map/slice.hpp): JSON, or a C header if `out` ends in .h; one file for each
///   lane (`_LANE` if there are several).
/// - `nav2`: masks for Nav2's costmap filters, on one grid: `out`_keepout.pgm (nav2_keepout.hpp)
///   and, if the map has speeds, the speed mask `out`.pgm (nav2_speed.hpp). Each has a .yaml, and
///   the parameters of its filter in `_filter.yaml`. With `layers` {"occupancy"}: the occupancy
///   grid as maps of modes trinary and scale instead (nav2_occupancy.hpp).
/// - `lanelet2`: lanes and turns as lanelets with speed limits, crossings as crosswalks, parking
///   spaces as areas (profile autoware: as its parking spaces and lots), in an OSM file; needs the
///   origin.
/// - `commonroad`: the same as a CommonRoad scenario, XML 2020a, with a planning problem.
/// - `opendrive`: the same as roads and junctions, OpenDRIVE 1.6; in the map frame, or with the
///   origin in east and north of it with a geoReference.
///
/// Objects that the format cannot represent are added to `notes`, if it is not null.
///
/// Files appear whole or not at all. Throws InvalidOption for an unknown format (with the nearest
/// one); BadInput for a map that cannot be read, has no content for the format, or lacks an origin
/// that the format needs; StorageError.
std::vector<std::filesystem::path> export_map(const std::filesystem::path& map,
                                              const std::string& format,
                                              const std::filesystem::path& out,
                                              const ExportOptions& options = {},
                                              ExportNotes* notes = nullptr);

}  // namespace roadbook
