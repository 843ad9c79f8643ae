#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "base/messages.hpp"

namespace roadbook {

/// Searches for each ground label in the images of the sessions in which the label has no anchor.
/// Stores the places where it was found (semantics/labels/label_sightings.hpp). Reports whether
/// these places agree with the map. `drives` are the folders of drives that have moved from the
/// path stored in the map. Returns the result that `--json` prints. Throws BadInput if there are no
/// labels or no images, and Interrupted.
[[nodiscard]] nlohmann::ordered_json run_look_again(
    const std::filesystem::path& map,
    const std::vector<std::filesystem::path>& drives,
    Messages& messages);

}  // namespace roadbook
