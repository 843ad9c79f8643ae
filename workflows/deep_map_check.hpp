#pragma once

#include <filesystem>

#include "base/messages.hpp"
#include "mapping/store/map_check.hpp"

namespace roadbook {

/// `check_map`, and if that finds nothing, the checks of mapping/checks/deep_check.hpp.
/// Descriptors are compared with the recordings; a message names the sessions whose recordings are
/// missing. Throws StorageError.
[[nodiscard]] MapReport check_map_deep(const std::filesystem::path& map,
                                       int num_threads,
                                       const Messages& messages);

}  // namespace roadbook
