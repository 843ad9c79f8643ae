#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exchange/export/export_notes.hpp"
#include "exchange/export/export_options.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {

// One function for each format. `export_map` (export_map.hpp) documents them. Each returns the
// files written.

using Paths = std::vector<std::filesystem::path>;

Paths export_tum(const std::filesystem::path& map, const std::filesystem::path& out);
Paths export_coco(const std::filesystem::path& map, const std::filesystem::path& out);
Paths export_yolo(const std::filesystem::path& map, const std::filesystem::path& out);
Paths export_geojson(const std::filesystem::path& map,
                     const std::filesystem::path& out,
                     const ExportOptions& options,
                     ExportNotes& notes);
Paths export_geotiff(const std::filesystem::path& map,
                     const std::filesystem::path& out,
                     const ExportOptions& options);
Paths export_path(const std::filesystem::path& map,
                  const std::filesystem::path& out,
                  const ExportOptions& options);
Paths export_spm(const std::filesystem::path& map,
                 const std::filesystem::path& out,
                 const ExportOptions& options);
Paths export_nav2(const std::filesystem::path& map,
                  const std::filesystem::path& out,
                  const ExportOptions& options,
                  ExportNotes& notes);
Paths export_qgis(const std::filesystem::path& map, const std::filesystem::path& out);
Paths export_lanelet2(const std::filesystem::path& map,
                      const std::filesystem::path& out,
                      const ExportOptions& options,
                      ExportNotes& notes);
Paths export_commonroad(const std::filesystem::path& map,
                        const std::filesystem::path& out,
                        const ExportOptions& options,
                        ExportNotes& notes);
Paths export_opendrive(const std::filesystem::path& map,
                       const std::filesystem::path& out,
                       const ExportOptions& options,
                       ExportNotes& notes);
Paths export_gpkg(const std::filesystem::path& map,
                  const std::filesystem::path& out,
                  const ExportOptions& options);

/// Returns the names of the raster layers `asked`, or of all if it is empty. Throws BadInput if the
/// map lacks one of them.
[[nodiscard]] std::vector<std::string> chosen_rasters(const MapLayers& layers,
                                                      const std::vector<std::string>& asked);

/// Returns the vector layers `asked`, or all if it is empty, with labels at their current
/// positions. Throws BadInput if the map lacks one of them.
[[nodiscard]] std::vector<VectorLayer> chosen_vector_layers(const MapLayers& layers,
                                                            const std::vector<std::string>& asked);

}  // namespace roadbook
