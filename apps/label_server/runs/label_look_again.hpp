#pragma once

#include <filesystem>
#include <vector>

#include "apps/console.hpp"

namespace roadbook {

/// Searches for each ground label in the images of the sessions in which the label has no anchor.
/// Stores the places where it was found (semantics/labels/label_sightings.hpp). Reports whether
/// these places agree with the map. `drives` are the folders of drives that have moved from the
/// path stored in the map. Throws BadInput if there are no labels or no images, and Interrupted.
void run_look_again(const std::filesystem::path& map,
                    const std::vector<std::filesystem::path>& drives,
                    Console& console);

}  // namespace roadbook
