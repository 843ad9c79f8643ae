#pragma once

#include <filesystem>

#include "mapping/existing_map.hpp"

namespace roadbook {

/// Whether the labels of a map may go over to one that takes its place. A label names its session
/// by number: in a map of other drives it would hang on another drive, or on none. Throws BadInput
/// that says how many hang on sessions that do not stay, and of which drives.
void check_labels_stay(const std::filesystem::path& file, const ExistingMap& existing);

}  // namespace roadbook
