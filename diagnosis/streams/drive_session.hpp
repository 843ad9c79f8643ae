#pragma once

#include <filesystem>
#include <optional>

#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// The session of `map` that was made from the drive. It is found by digest. Otherwise it is the
/// only session with the drive's folder name, if the recorded times (of images, or of readings if
/// there are none) span those of the session; two drives on different days may have the same name.
/// No value if there is none.
[[nodiscard]] std::optional<int> find_session(const Map& map, const Drive& drive);
/// The same; throws BadInput naming `file` if there is none.
[[nodiscard]] int session_of(const Map& map, const Drive& drive, const std::filesystem::path& file);

}  // namespace roadbook
