#include "workflows/export_place.hpp"

#include <algorithm>

#include "exchange/export/picture_edge.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/pieces.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_reading.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_drives.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {
namespace {

// Returns whether the export contains labels: the format can hold them, and the requested layers
// (if any) include a layer of labels.
bool holds_labels(const ExportRequest& request) {
  for (const char* format : {"coco", "yolo", "lanelet2", "commonroad", "opendrive", "nav2"})
    if (request.format == format) return true;
  if (request.format != "geojson" && request.format != "gpkg") return false;
  const auto& layers = request.options.layers;
  return layers.empty() || std::any_of(layers.begin(), layers.end(), is_label_layer);
}

std::vector<std::string> rasters_of(const std::filesystem::path& map) {
  std::vector<std::string> names;
  for (const LayerInfo& layer : MapLayers(map).list())
    if (layer.raster) names.push_back(layer.name);
  return names;
}

}  // namespace

std::vector<Problem> labels_without_place(const ExportRequest& request) {
  if (!holds_labels(request)) return {};
  std::vector<Label> labels = read_labels(request.map);
  // No export contains rejected hypotheses.
  std::erase_if(labels, [](const Label& label) { return is_rejected_kind(label.kind); });
  if (labels.empty()) return {};
  const auto lost = warning_of_lost_places(request.map, load_map(request.map), labels);
  return lost ? std::vector<Problem>{*lost} : std::vector<Problem>{};
}

ExportResult export_place(const ExportRequest& request) {
  const MapReading reading(request.map);
  require_one_piece(request.map);
  ExportResult result;
  result.files =
      export_map(request.map, request.format, request.output, request.options, &result.left_out);
  result.warnings = warnings_of_picture_edge(request.map, request.format);
  if (request.format == "gpkg" || request.format == "geojson")
    result.rasters_left_out = rasters_of(request.map);
  reading.require_same_map();
  return result;
}

}  // namespace roadbook
