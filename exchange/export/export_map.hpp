#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exchange/export/export_notes.hpp"
#include "exchange/export/export_options.hpp"

namespace roadbook {

// Maps written in the formats of other programs.

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
