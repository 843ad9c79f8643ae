#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/store/map_file.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// Labels as layers of the map, where its poses have them today: polygons `parking_spaces` and
// `crossings`, and `other_labels` for all other classes and for parking spaces that are no
// rectangles. Rejections are in none of them.
//
// Columns: space (the label's id), class, version, source, who, score, length_m, width_m,
// heading_rad (null for polygons), sigma_m (largest axis of the place's covariance), coverage
// (share of the outline that its camera image shows), note, date_utc (of the newest session),
// edited_utc, sessions (the one it hangs on).

/// Whether a layer of that name is one of these.
[[nodiscard]] bool is_label_layer(const std::string& name);

/// Only layers that have features. Labels without a place are left out
/// (`warning_of_lost_places` tells of them).
[[nodiscard]] std::vector<VectorLayer> label_layers(const Map& map,
                                                    const std::vector<Label>& labels);

/// Writes them; removes those of earlier labels that are gone. Layers of these names that came from
/// elsewhere stay where no label takes their place.
void write_label_layers(MapUpdate& update,
                        const MapLayers& before,
                        const Map& map,
                        const std::vector<Label>& labels);

/// The same for a finished map on its own; nothing where it has neither labels nor such layers.
void renew_label_layers(const std::filesystem::path& map);

/// Whether they hold every label in its newest version, and no other. Throws BadInput.
[[nodiscard]] bool label_layers_are_current(const std::filesystem::path& map);

/// The layers of a map file's labels as they are today, whatever is stored. Throws BadInput.
[[nodiscard]] std::vector<VectorLayer> label_layers_of_today(const MapLayers& layers);

/// A vector layer: of `today` where it is among them, else as it is stored, else empty.
[[nodiscard]] std::optional<VectorLayer> layer_of_today(const MapLayers& layers,
                                                        const std::vector<VectorLayer>& today,
                                                        const std::string& name);
/// Names of all vector layers with `today` in place of what earlier labels have left, in order.
[[nodiscard]] std::vector<std::string> vector_layers_of_today(
    const MapLayers& layers, const std::vector<VectorLayer>& today);

}  // namespace roadbook
