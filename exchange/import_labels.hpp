#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exchange/export_map.hpp"
#include "exchange/label_outlines.hpp"

namespace roadbook {

// Labels read back from the formats of other programs and hung on the vehicle poses of a map.

/// Names of the formats `import_labels` knows.
[[nodiscard]] const std::vector<std::string>& label_import_formats();

struct LabelImport {
  std::size_t stored = 0;
  /// Were in the map or earlier in the file: class and outline to a millimetre, or (yolo) what of
  /// the outline lies in the file's picture.
  std::size_t already = 0;
};

/// Outlines of a file, map frame; every fault of it in one BadInput.
///
/// - `coco`: a JSON of instances of one image, the map's overhead image: polygons, or boxes where
///   an annotation has no polygon; they may reach over the image's edge. `images[0].world` tells
///   its place; without it the image must have the size of the map's own.
/// - `yolo`: a folder with data.yaml and labels/overhead.txt, rows `class x y x y ...` in shares of
///   the image; images/overhead.pgw tells its place, or images/overhead.png is the map's own.
/// - `geojson`: polygons in WGS84 degrees with a property `class`; needs the map's place on the
///   earth (`origin`, or the map's own).
///
/// Classes named `not_X` are left out: what somebody rejected is no thing.
[[nodiscard]] std::vector<LabelOutline> read_label_outlines(const std::filesystem::path& map,
                                                            const std::string& format,
                                                            const std::filesystem::path& source,
                                                            const std::optional<GeoOrigin>& origin);

/// Stores what is not in the map yet, all or nothing, in the name of `who`, and renews the map's
/// label layers; one step, for who takes it back. Four corners within 2 cm of a rectangle become a
/// box along their longer side, unless the class is one of polygons; what `export_map` wrote (coco,
/// geojson) says its shape, and of a box which side is ahead. How exact they are is what the file
/// says (`sigma_m`, in COCO's `attributes`, of the place there: pose and drawing; what the label's
/// pose here has of it is not added again), or 0.12 m of the drawing where it says nothing. Throws
/// BadInput, also naming outlines that no image of the map shows; StorageError.
LabelImport import_labels(const std::filesystem::path& map,
                          const std::string& format,
                          const std::filesystem::path& source,
                          const std::string& who,
                          const std::optional<GeoOrigin>& origin = std::nullopt);

}  // namespace roadbook
