#pragma once

#include <filesystem>
#include <vector>

#include "base/messages.hpp"

namespace roadbook {

/// Drives that the map in `map_file` is to be made of when `given` are to go into it: where it is
/// there and has none of them or only some, its own drives first, where it says they are, then
/// those of `given` that it has not. `given` as they are where no map is there, or where they are
/// all of its drives or begin with them.
///
/// Throws BadInput for a map that is damaged, and for a drive of it that is not at hand unchanged.
[[nodiscard]] std::vector<std::filesystem::path> with_drives_of_map(
    const std::filesystem::path& map_file,
    const std::vector<std::filesystem::path>& given,
    const Messages& messages);

}  // namespace roadbook
