#pragma once

#include "mapping/layers/map_layers.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Layer `poses`: keyframes in the map frame with heading, uncertainty, date and session.
[[nodiscard]] VectorLayer pose_layer(const Map& map);

/// Layer `landmark_points`: landmarks in the map frame with uncertainty and number of views.
[[nodiscard]] VectorLayer landmark_layer(const Map& map);

}  // namespace roadbook
