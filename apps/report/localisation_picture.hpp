#pragma once

#include <string>

#include "workflows/localisation/localise_in_map.hpp"

namespace roadbook {

/// Draws a localised drive as one SVG file: the plan, with each frame in the colour of its status
/// over the poses of the map; the standard deviation of the place along the drive, and the true
/// error where it is known; the landmarks that each frame agreed with.
[[nodiscard]] std::string localisation_picture(const LocaliseResult& result);

}  // namespace roadbook
