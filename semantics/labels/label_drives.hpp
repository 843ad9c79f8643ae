#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "mapping/store/existing_map.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

/// Whether the labels of a map may go over to one that takes its place. A label names its session
/// by number: in a map of other drives it would hang on another drive, or on none. Throws BadInput
/// that says how many hang on sessions that do not stay, and of which drives.
void check_labels_stay(const std::filesystem::path& file, const ExistingMap& existing);

/// How many labels on the ground have no place in a map, because it has no pose of the moment at
/// which they were drawn, and of which drives. Empty where all have one.
[[nodiscard]] std::optional<Problem> warning_of_lost_places(const std::filesystem::path& file,
                                                            const Map& map,
                                                            const std::vector<Label>& labels);

}  // namespace roadbook
