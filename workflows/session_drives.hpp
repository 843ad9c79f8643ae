#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/messages.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Folder of a session's drive: the map stores it relative to its own folder where it can.
[[nodiscard]] std::filesystem::path session_folder(const std::filesystem::path& map_file,
                                                   const Session& session);

/// The drives of all sessions: those `given`, the others where the map says they lie; empty where
/// one is not at hand, which is said. Throws BadInput for a drive the map was not made of.
[[nodiscard]] std::vector<std::optional<Drive>> open_session_drives(
    const std::filesystem::path& map_file,
    const Map& map,
    const std::vector<std::filesystem::path>& given,
    const Messages& messages);

}  // namespace roadbook
