#pragma once

#include <optional>
#include <vector>

#include "drive/drive.hpp"
#include "semantics/labels/label_evidence.hpp"

namespace roadbook {

/// Images of a map's keyframes from the drives of its sessions, empty where one is not at hand.
/// Both must outlive it.
[[nodiscard]] KeyframeImages images_of_drives(const Map* map,
                                              const std::vector<std::optional<Drive>>* drives);

}  // namespace roadbook
