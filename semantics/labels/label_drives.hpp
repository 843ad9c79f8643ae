#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "mapping/store/existing_map.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// Checks that a map can be replaced without losing labels. A label names its session by index, so
/// its drive must keep that index. Throws BadInput that counts the labels whose sessions would not
/// be kept, for each drive.
void check_labels_stay(const std::filesystem::path& file, const ExistingMap& existing);

/// Counts the active ground labels without a position, for each drive: the map has no pose at the
/// time of their image. Empty if every label has a position.
[[nodiscard]] std::optional<Problem> warning_of_lost_places(const std::filesystem::path& file,
                                                            const Map& map,
                                                            const std::vector<Label>& labels);

}  // namespace roadbook
