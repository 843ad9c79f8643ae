#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/messages.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Returns the folder of a session's drive. The map stores it relative to its own folder if
/// possible.
[[nodiscard]] std::filesystem::path session_folder(const std::filesystem::path& map_file,
                                                   const Session& session);

/// Opens the drives of all sessions. It uses the drives `given`, and for other sessions the path
/// stored in the map. The entry is empty where the drive is not available, and a message reports
/// this. Throws BadInput for a drive that is not part of the map.
[[nodiscard]] std::vector<std::optional<Drive>> open_session_drives(
    const std::filesystem::path& map_file,
    const Map& map,
    const std::vector<std::filesystem::path>& given,
    const Messages& messages);

}  // namespace roadbook
