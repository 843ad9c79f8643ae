#pragma once

#include <filesystem>
#include <optional>

#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// The session of `map` that is the drive: by digest, else the only one of its folder's name if
/// what the drive recorded (images, or readings where there are none) spans the session's times: of
/// two drives that are called alike, one on Monday and one on Tuesday, only one made the map.
/// Nothing where there is none.
[[nodiscard]] std::optional<int> find_session(const Map& map, const Drive& drive);
/// The same; throws BadInput that names `file` where there is none.
[[nodiscard]] int session_of(const Map& map, const Drive& drive, const std::filesystem::path& file);

}  // namespace roadbook
