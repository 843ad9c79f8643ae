#pragma once

#include <optional>

#include "exchange/import/json_fields.hpp"
#include "exchange/import/label_readers.hpp"

namespace roadbook {

/// The outline of one annotation of a COCO file, map frame, without its class. `where`: its path in
/// the file.
///
/// - `segmentation` of one polygon, or `bbox` where there is none.
/// - `attributes.rotation` (CVAT): the box is turned clockwise in the picture about its middle
/// [deg].
///   A polygon that repeats the corners of `bbox` is turned too; any other stands as it is drawn.
/// - `attributes` of roadbook's own: `shape`, `heading_rad`, `sigma_m`, `note`; `space`, `version`,
///   `edited_utc`.
///
/// Empty where the annotation cannot be a label: with a line in `file.left_out` where it is another
/// kind of thing (a group, a mask, several parts, key points, a turn whose sense no standard
/// tells), with a fault in `fields` where it is malformed.
[[nodiscard]] std::optional<LabelOutline> read_coco_annotation(const nlohmann::json& annotation,
                                                               const std::string& where,
                                                               const PicturePlace& place,
                                                               JsonFields& fields,
                                                               LabelFile& file);

}  // namespace roadbook
