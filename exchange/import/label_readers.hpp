#pragma once

#include <nlohmann/json_fwd.hpp>

#include "exchange/export/geo_origin.hpp"
#include "exchange/export/label_outlines.hpp"

namespace roadbook {

// One function for each format. `read_label_file` (import_labels.hpp) documents them.

/// Annotations that are no labels of this map, and why.
struct LabelsLeftOut {
  Problem reason;
  std::size_t count = 1;
  /// Not features of other layers, which lie in a file of a whole map and are meant for others.
  bool of_labels = true;
};

struct LabelFile {
  std::vector<LabelOutline> outlines;
  std::vector<LabelsLeftOut> left_out;
  std::vector<Problem> notes;  ///< of entries that were interpreted differently from the file
};

LabelFile read_coco(const std::filesystem::path& file, const MapLayers& layers);
LabelFile read_yolo(const std::filesystem::path& folder, const MapLayers& layers);
/// `class_field`: the property that holds the class; empty: `class`.
LabelFile read_geojson(const std::filesystem::path& file,
                       const GeoOrigin& origin,
                       const std::string& class_field);

/// The files of a YOLO folder that belong to the overhead image, as trainers and labelling programs
/// lay them out: `labels/overhead.txt`, or the only file below `labels` or the folder whose name
/// contains "overhead"; the picture of the same name, where there is one. Throws BadInput.
struct YoloFiles {
  std::filesystem::path rows;
  std::filesystem::path picture;             ///< empty: none
  std::vector<std::filesystem::path> other;  ///< rows of other pictures
};
[[nodiscard]] YoloFiles yolo_files(const std::filesystem::path& folder);

/// Position of the picture of a YOLO folder: from its world file, else that of the map's own image.
[[nodiscard]] PicturePlace yolo_picture_place(const std::filesystem::path& folder,
                                              const MapLayers& layers);

/// Throws BadInput unless a picture of `width` x `height` has the size of the map's overhead image.
void require_size(const std::string& file, const PicturePlace& map, int width, int height);

/// The identity of the label that an outline was written from, by a file's fields `space`,
/// `version` and `edited_utc`; empty without a number `space`.
[[nodiscard]] std::optional<LabelIdentity> identity_of(const nlohmann::json& fields);

/// A warning that says why an annotation is left out.
[[nodiscard]] LabelsLeftOut left_out(const std::string& file,
                                     const std::string& field,
                                     const std::string& got,
                                     const std::string& want);

}  // namespace roadbook
