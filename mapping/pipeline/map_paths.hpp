#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

// Files and folders as a map names them. A map is copied to other machines, so it names them
// relative to its own folder.

/// Path of `file` relative to the folder of `map`, such as "../drives/monday". A symbolic link
/// below the map's folder stays a link. Never absolute. A file that shares no folder with the map
/// gets a path through the root of the file system.
[[nodiscard]] std::string path_from_map(const std::filesystem::path& file,
                                        const std::filesystem::path& map);

/// Returns `problems` with files relative to the map's folder, for notes in the map. A file that
/// shares no folder with the map keeps its name in its drive, such as "monday/cam0/data.csv", or
/// its own name alone if it lies in none of `drives`.
[[nodiscard]] std::vector<Problem> problems_from_map(
    std::vector<Problem> problems,
    const std::vector<std::filesystem::path>& drives,
    const std::filesystem::path& map);

}  // namespace roadbook
