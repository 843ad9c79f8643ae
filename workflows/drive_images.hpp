#pragma once

#include <optional>
#include <vector>

#include "drive/drive.hpp"
#include "semantics/labels/label_evidence.hpp"

namespace roadbook {

/// Returns the images of a map's keyframes from the drives of its sessions. A drive is empty where
/// it is not available. `map` and `drives` must outlive the result.
[[nodiscard]] KeyframeImages images_of_drives(const Map* map,
                                              const std::vector<std::optional<Drive>>* drives);

}  // namespace roadbook
