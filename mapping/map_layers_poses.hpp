#pragma once

#include "mapping/map.hpp"
#include "mapping/map_layers.hpp"

namespace roadbook {

/// Layer `poses`: keyframes in the map frame with heading, uncertainty, date and session.
[[nodiscard]] VectorLayer pose_layer(const Map& map);

/// Layer `landmark_points`: landmarks in the map frame with uncertainty and number of views.
[[nodiscard]] VectorLayer landmark_layer(const Map& map);

}  // namespace roadbook
