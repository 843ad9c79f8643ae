#pragma once

#include <optional>
#include <string>
#include <vector>

namespace roadbook {

// How QGIS draws the vector layers of a map: its style format QML, as QGIS 3 writes and reads it.
// Colours are made for layers that lie over the grey overhead image.

/// The two elements of a style that roadbook sets.
struct LayerStyle {
  std::string renderer;  ///< element `renderer-v2`
  std::string labeling;  ///< element `labeling`; empty: no labels
};

/// The style of a layer of this name, in any map; empty if roadbook has no style for it.
[[nodiscard]] std::optional<LayerStyle> layer_style(const std::string& layer);

/// The style as a QML document.
[[nodiscard]] std::string qml_of(const LayerStyle& style);

}  // namespace roadbook
