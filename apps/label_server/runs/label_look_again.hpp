#pragma once

#include <filesystem>
#include <vector>

#include "apps/console.hpp"

namespace roadbook {

/// Looks for all labels on the ground in the images of the sessions that they do not hang on,
/// stores where they were found (semantics/labels/label_sightings.hpp), and says whether that
/// agrees with the map. `drives`: folders of sessions' drives that are not where the map says.
/// Throws BadInput where there is nothing to look for or to look into, Interrupted.
void run_look_again(const std::filesystem::path& map,
                    const std::vector<std::filesystem::path>& drives,
                    Console& console);

}  // namespace roadbook
