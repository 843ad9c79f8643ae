#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/report/report_data.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {

/// "data:image/...;base64,..." of an encoded picture.
[[nodiscard]] std::string data_uri(const std::string& mime_type,
                                   const std::vector<unsigned char>& bytes);

/// The figures (SVG, PNG) in a folder that `roadbook evaluate` wrote, by name. Throws BadInput
/// where there is none.
[[nodiscard]] std::vector<EvaluationFigure> evaluation_figures(const std::filesystem::path& folder);

/// The map's overhead image, made small enough for a page (at most `max_px` on a side), read row of
/// tiles by row of tiles so that memory does not grow with the place. Empty where there is none.
[[nodiscard]] std::optional<GroundPicture> overhead_picture(const MapLayers& layers,
                                                            int max_px = 1400);

}  // namespace roadbook
