#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/report/report_data.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {

/// Returns "data:image/...;base64,..." for an encoded picture.
[[nodiscard]] std::string data_uri(const std::string& mime_type,
                                   const std::vector<unsigned char>& bytes);

/// Returns the figures (SVG, PNG) in an output folder of `roadbook evaluate`, by name. Throws
/// BadInput if the folder has no figures.
[[nodiscard]] std::vector<EvaluationFigure> evaluation_figures(const std::filesystem::path& folder);

/// Returns the map's overhead image, reduced to at most `max_px` on each side. The function reads
/// one row of tiles at a time, so that memory does not grow with the size of the place. Empty if
/// the map has no overhead image.
[[nodiscard]] std::optional<GroundPicture> overhead_picture(const MapLayers& layers,
                                                            int max_px = 1400);

}  // namespace roadbook
