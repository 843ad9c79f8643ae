#pragma once

#include <filesystem>

#include "base/messages.hpp"
#include "mapping/localisation/register_drive.hpp"

namespace roadbook {

/// A drive that the map does not hold, localised in it: a map of the drive alone is made for the
/// occasion and thrown away; that of `file` is not changed. Throws BadInput, StorageError,
/// Interrupted, and Refused where the drive is not found in the map.
[[nodiscard]] LocalisedDrive localised_drive(const Map& frozen,
                                             const std::filesystem::path& file,
                                             const std::filesystem::path& drive,
                                             int num_threads,
                                             Messages& messages);

}  // namespace roadbook
