#pragma once

#include <filesystem>
#include <vector>

#include "base/messages.hpp"

namespace roadbook {

/// Returns the drives from which to build the map in `map_file`, so that the drives `given` become
/// part of it.
///
/// If the map exists and lacks some or all of `given`, the result has the map's own drives first,
/// at the paths stored in the map. The drives of `given` that the map lacks follow. The result is
/// `given` unchanged in three cases: no map exists, the map has all of `given`, or `given` begins
/// with the map's drives.
///
/// Throws BadInput if the map is damaged, or if one of its drives is not available or has changed.
[[nodiscard]] std::vector<std::filesystem::path> with_drives_of_map(
    const std::filesystem::path& map_file,
    const std::vector<std::filesystem::path>& given,
    const Messages& messages);

}  // namespace roadbook
