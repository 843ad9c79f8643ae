#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/messages.hpp"

namespace roadbook {

/// Throws BadInput for a drive that is given twice, under whatever names. Returns the digests.
std::vector<std::string> refuse_same_drives(const std::vector<std::filesystem::path>& drives);

/// What a command with drives and a map that exists has to do.
struct FurtherDrives {
  bool is_new = false;                        ///< there is no map yet
  std::vector<std::filesystem::path> drives;  ///< that extend the map, in this order
};

/// Returns the drives of `given` by which the map in `map_file` is to be extended. The first of
/// `given` may be the last sessions of the map, or all of them: a stopped command continues, and a
/// finished one has nothing left. Throws BadInput if a drive is given twice, under whatever
/// names, or is another session of the map; also if the map is damaged.
[[nodiscard]] FurtherDrives further_drives(const std::filesystem::path& map_file,
                                           const std::vector<std::filesystem::path>& given,
                                           const Messages& messages);

/// Returns the drives from which to build the map in `map_file`, so that the drives `given` become
/// part of it.
///
/// If the map exists and lacks all of `given`, the result has the map's own drives first, at the
/// paths stored in the map; `given` follows. If `given` are the last drives of the map, the command
/// has been done before, and the result is the map's drives. The result is `given` unchanged if no
/// map exists, or if `given` begins with the map's drives.
///
/// Throws BadInput if a drive is given twice, under whatever names, or is in the map and none of
/// these cases applies. Throws it also if the map is damaged, or if one of its drives is not
/// available or has changed.
[[nodiscard]] std::vector<std::filesystem::path> with_drives_of_map(
    const std::filesystem::path& map_file,
    const std::vector<std::filesystem::path>& given,
    const Messages& messages);

}  // namespace roadbook
