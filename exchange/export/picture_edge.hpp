#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "exchange/export/label_outlines.hpp"

namespace roadbook {

// Labels at the edge of the overhead image: a space may lie partly outside.

/// Returns the parts of an outline inside the picture, map frame [m]. If no corner lies outside, it
/// is the unchanged outline. Otherwise it is cut at the edge; parts less than a pixel wide are left
/// out. The outline must not cross itself; one that cannot be cut has no parts.
[[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> parts_in_picture(
    const PicturePlace& place, const std::vector<Eigen::Vector2d>& outline);

/// The parts of `outlines_of_labels` inside the picture. Throws BadInput where no part is inside.
[[nodiscard]] std::vector<LabelOutline> outlines_in_picture(const MapLayers& layers,
                                                            const PicturePlace& place);

/// Returns warnings with the number of labels that an export to `format` leaves out, because they
/// lie outside the overhead image, and that it cuts at the edge (yolo). Empty for formats without
/// the image.
[[nodiscard]] std::vector<Problem> warnings_of_picture_edge(const std::filesystem::path& map,
                                                            const std::string& format);

}  // namespace roadbook
