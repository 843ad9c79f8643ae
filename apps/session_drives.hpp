#pragma once

#include <filesystem>

#include "mapping/map.hpp"

namespace roadbook {

/// Folder of a session's drive: the map stores it relative to its own folder where it can.
[[nodiscard]] std::filesystem::path session_folder(const std::filesystem::path& map_file,
                                                   const Session& session);

}  // namespace roadbook
