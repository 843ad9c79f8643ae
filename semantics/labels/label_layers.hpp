#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/store/map_file.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// Labels as vector layers of the map, at the current map poses: polygons `parking_spaces`,
// `crossings`, and `other_labels` for all other classes and for parking spaces that are not boxes.
// Rejections are in no layer.
//
// Columns: space (the label's id), class, version, source, who, score, length_m, width_m,
// heading_rad (null for polygons), sigma_m (square root of the largest eigenvalue of the position's
// covariance), coverage (share of the outline inside the label's image), note, date_utc (of the
// newest session), edited_utc, sessions (the session of its anchor).

/// True if `name` is the name of one of these layers.
[[nodiscard]] bool is_label_layer(const std::string& name);

/// The layers that have features. Labels without a position are left out (see
/// `warning_of_lost_places`).
[[nodiscard]] std::vector<VectorLayer> label_layers(const Map& map,
                                                    const std::vector<Label>& labels);

/// Writes the layers and removes outdated ones. A layer with one of these names that another
/// program wrote is kept, unless a layer of labels replaces it.
void write_label_layers(MapUpdate& update,
                        const MapLayers& before,
                        const Map& map,
                        const std::vector<Label>& labels);

/// Same for a finished map; does nothing if the map has neither labels nor layers of labels.
void renew_label_layers(const std::filesystem::path& map);

/// True if the stored layers hold exactly the active labels at their newest versions. Throws
/// BadInput.
[[nodiscard]] bool label_layers_are_current(const std::filesystem::path& map);

/// Layers computed from the map's labels and current poses; stored layers are ignored. Throws
/// BadInput.
[[nodiscard]] std::vector<VectorLayer> label_layers_of_today(const MapLayers& layers);

/// A vector layer by name: from `today` if it is there, else as stored; empty if there is none. A
/// stored layer of labels that `today` lacks is outdated and is not returned.
[[nodiscard]] std::optional<VectorLayer> layer_of_today(const MapLayers& layers,
                                                        const std::vector<VectorLayer>& today,
                                                        const std::string& name);
/// Sorted names of all vector layers, with `today` in place of the stored layers of labels.
[[nodiscard]] std::vector<std::string> vector_layers_of_today(
    const MapLayers& layers, const std::vector<VectorLayer>& today);

}  // namespace roadbook
