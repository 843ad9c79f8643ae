#pragma once

#include <optional>

#include "exchange/import/json_fields.hpp"
#include "exchange/import/label_readers.hpp"

namespace roadbook {

/// Reads the outline of one annotation of a COCO file, map frame, without its class. `where`: its
/// path in the file, for messages. It reads these fields:
///
/// - `segmentation` with one polygon, else `bbox`.
/// - `attributes.rotation` (CVAT): angle [deg] by which the box is turned clockwise in the picture
///   about its middle. A polygon equal to the corners of `bbox` is turned too; any other is not.
/// - roadbook's own `attributes`: `shape`, `heading_rad`, `sigma_m`, `note`, `space`, `version`,
///   `edited_utc`.
///
/// Empty if the annotation cannot be a label. If it is valid but of another kind (a group, a mask,
/// several parts, key points, a rotation without a standard sense), adds a line to `file.left_out`.
/// If it is malformed, adds a fault to `fields`.
[[nodiscard]] std::optional<LabelOutline> read_coco_annotation(const nlohmann::json& annotation,
                                                               const std::string& where,
                                                               const PicturePlace& place,
                                                               JsonFields& fields,
                                                               LabelFile& file);

}  // namespace roadbook
