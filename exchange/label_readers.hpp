#pragma once

#include <nlohmann/json.hpp>

#include "exchange/geo_origin.hpp"
#include "exchange/label_outlines.hpp"

namespace roadbook {

// One function a format; contracts at `read_label_outlines`.

using Outlines = std::vector<LabelOutline>;

Outlines read_coco(const std::filesystem::path& file, const MapLayers& layers);
Outlines read_yolo(const std::filesystem::path& folder, const MapLayers& layers);
Outlines read_geojson(const std::filesystem::path& file, const GeoOrigin& origin);

/// Where the picture of a YOLO folder lies: as its world file says, else as the map's own.
[[nodiscard]] PicturePlace yolo_picture_place(const std::filesystem::path& folder,
                                              const MapLayers& layers);

/// A whole JSON file. Throws BadInput with the line of what is no JSON.
[[nodiscard]] nlohmann::json read_json_file(const std::filesystem::path& file);

/// The whole number in the same place of a picture's size as the map's overhead image has; BadInput
/// where it has another.
void require_size(const std::string& file, const PicturePlace& map, int width, int height);

}  // namespace roadbook
