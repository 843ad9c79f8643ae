#include "exchange/import/import_labels.hpp"

#include "base/wall_clock.hpp"
#include "exchange/import/foreign_classes.hpp"
#include "exchange/import/label_matching.hpp"
#include "exchange/import/outline_labels.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "mapping/store/map_file_open.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {
namespace {

// What a file has, where none of it can be used: a refusal that says why.
void refuse_unusable(const std::string& source, const LabelFile& file) {
  if (!file.outlines.empty()) return;
  std::vector<Problem> problems;
  for (const LabelsLeftOut& one : file.left_out) {
    if (!one.of_labels) continue;
    problems.push_back(one.reason);
    problems.back().severity = Severity::kError;
  }
  if (!problems.empty()) throw BadInput(problems);
  if (file.left_out.empty())
    throw BadInput({Severity::kError, source, 0, "labels", "none", "some"});
}

}  // namespace

std::size_t LabelImport::count_left_out() const {
  std::size_t count = 0;
  for (const LabelsLeftOut& one : left_out) count += one.count;
  return count;
}

LabelsLeftOut left_out(const std::string& file,
                       const std::string& field,
                       const std::string& got,
                       const std::string& want) {
  return {{Severity::kWarning, file, 0, field, got, want}};
}

void require_size(const std::string& file, const PicturePlace& map, int width, int height) {
  if (map.width == width && map.height == height) return;
  throw BadInput({Severity::kError, file, 0, "image",
                  std::to_string(width) + " x " + std::to_string(height) + " pixels",
                  std::to_string(map.width) + " x " + std::to_string(map.height) +
                      ", as the map's overhead image has"});
}

const std::vector<std::string>& label_import_formats() {
  static const std::vector<std::string> formats{"coco", "yolo", "geojson"};
  return formats;
}

LabelFile read_label_file(const std::filesystem::path& map,
                          const std::string& format,
                          const std::filesystem::path& source,
                          const std::optional<GeoOrigin>& origin,
                          const std::string& class_field) {
  const MapLayers layers(map);
  LabelFile file;
  if (format == "geojson") {
    ExportOptions place;
    place.origin = origin;
    file = read_geojson(source, require_origin(map, place, "GeoJSON is in degrees"), class_field);
  } else {
    file = format == "yolo" ? read_yolo(source, layers) : read_coco(source, layers);
  }
  name_foreign_classes(layers, source.string(), file);
  refuse_unusable(source.string(), file);
  return file;
}

LabelImport import_labels(const std::filesystem::path& map,
                          const std::string& format,
                          const std::filesystem::path& source,
                          const std::string& who,
                          const std::optional<GeoOrigin>& origin,
                          const std::string& class_field) {
  const MapHold hold(existing_map_file(map));
  LabelFile file = read_label_file(map, format, source, origin, class_field);
  const MapLayers layers(map);
  const auto classes = read_label_classes(layers);
  std::optional<PicturePlace> cut_at;
  if (format == "yolo") cut_at = yolo_picture_place(source, layers);
  LabelImport result;
  {
    LabelStore store(map);
    auto matched = match_outlines(store.map(), store.events(), store.labels(), cut_at,
                                  source.string(), std::move(file.outlines));
    const NewLabels labels = labels_of_outlines(store.map(), matched, classes, source.string());
    const std::string request = kImportRequest + std::to_string(wall_clock_ns());
    if (!labels.created.empty() || !labels.changed.empty())
      store.create_all(labels.created, who, request, labels.changed);
    result.stored = labels.created.size();
    result.changed = labels.changed.size();
    result.already = matched.already;
    result.left_out = std::move(file.left_out);
    result.left_out.insert(result.left_out.end(), matched.left_out.begin(), matched.left_out.end());
    result.notes = std::move(file.notes);
  }
  renew_label_layers(map);
  return result;
}

}  // namespace roadbook
