#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "exchange/export/label_outlines.hpp"

namespace roadbook {

// Labels where the overhead image ends: a space may be drawn half out of it.

/// The parts of an outline that lie in the picture, map frame [m]. The outline itself if no corner
/// lies outside; otherwise its parts, cut at the edge, without parts less than a pixel wide. The
/// outline must not cross itself. An outline that cannot be cut has no parts.
[[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> parts_in_picture(
    const PicturePlace& place, const std::vector<Eigen::Vector2d>& outline);

/// The parts of `outlines_of_labels` inside the picture. Throws BadInput where no part is inside.
[[nodiscard]] std::vector<LabelOutline> outlines_in_picture(const MapLayers& layers,
                                                            const PicturePlace& place);

/// How many labels an export to `format` leaves out, as they lie outside the overhead image, and
/// how many it cuts at its edge (yolo). Empty for formats without the image.
[[nodiscard]] std::vector<Problem> warnings_of_picture_edge(const std::filesystem::path& map,
                                                            const std::string& format);

}  // namespace roadbook
