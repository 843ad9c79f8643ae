#pragma once

#include <filesystem>

#include "base/messages.hpp"
#include "mapping/localisation/register_drive.hpp"

namespace roadbook {

/// Localises a drive in a map that does not contain it. The function builds a temporary map of the
/// drive alone. The map in `file` does not change. Throws BadInput, StorageError, Interrupted, and
/// Refused if the drive cannot be localised.
[[nodiscard]] LocalisedDrive localised_drive(const Map& frozen,
                                             const std::filesystem::path& file,
                                             const std::filesystem::path& drive,
                                             int num_threads,
                                             Messages& messages);

}  // namespace roadbook
