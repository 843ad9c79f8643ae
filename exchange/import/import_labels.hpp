#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exchange/export/export_map.hpp"
#include "exchange/import/label_readers.hpp"

namespace roadbook {

// Import of labels from the formats of other programs, relative to the vehicle poses of a map.

/// Names of the formats `import_labels` knows.
[[nodiscard]] const std::vector<std::string>& label_import_formats();

/// Each annotation of a file is in one of the counts.
struct LabelImport {
  std::size_t stored = 0;
  std::size_t already = 0;  ///< were in the map, or earlier in the file
  std::size_t changed = 0;  ///< labels of this map that the file has in another shape or class
  std::vector<LabelsLeftOut> left_out;
  std::vector<Problem> notes;  ///< of entries that were interpreted differently from the file

  [[nodiscard]] std::size_t count_left_out() const;
};

/// Reads the outlines of a file, map frame, and its annotations that are no labels. Throws one
/// BadInput with all faults of the file.
///
/// - `coco`: a JSON file of instances. Only annotations of the overhead image count: the only
/// image,
///   the one with `world` (its position), or the one with the size of the map's overhead image.
///   Reads polygons, or boxes if an annotation has no polygon (coco_annotation.hpp). They may
///   extend beyond the image.
/// - `yolo`: a folder with data.yaml (or classes.txt) and labels/overhead.txt, rows `class x y x y
///   ...` or `class x y width height` in shares of the image. images/overhead.pgw gives the
///   position of the image; without it, the image is the map's own.
/// - `geojson`: polygons in WGS84 degrees with a property `class`. It needs the position of the map
///   on the earth (`origin`, or the one stored in the map). `class_field` names another property
///   for the class.
///
/// Straight corners are removed (outline_shape.hpp). A class that differs from one of the map only
/// in case, blanks or a plural s is that class. `not_X` is left out if X is a class of the map: it
/// means a rejected hypothesis. Another class of such a name is stored as `is_not_X`.
[[nodiscard]] LabelFile read_label_file(const std::filesystem::path& map,
                                        const std::string& format,
                                        const std::filesystem::path& source,
                                        const std::optional<GeoOrigin>& origin = std::nullopt,
                                        const std::string& class_field = {});

/// Stores labels that are not in the map yet, applies the changes of the file to labels of the map
/// (label_matching.hpp), all or nothing, in the name of `who`, and updates the map's label layers.
/// It is one step for undo.
///
/// Four corners that form a rectangle within the rounding of their file become a box along their
/// longer side, unless the class is one of polygons. Files of `export_map` (coco, geojson) state
/// the shape, and of a box the side that is ahead. The accuracy is that of the file (`sigma_m`, in
/// COCO's `attributes`: pose and drawing; the part of the label's pose in this map is not added
/// again), else 0.12 m of the drawing.
///
/// Throws BadInput, also for outlines that no image of the map shows and for a file without any
/// usable label; StorageError.
LabelImport import_labels(const std::filesystem::path& map,
                          const std::string& format,
                          const std::filesystem::path& source,
                          const std::string& who,
                          const std::optional<GeoOrigin>& origin = std::nullopt,
                          const std::string& class_field = {});

}  // namespace roadbook
