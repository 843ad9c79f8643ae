#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// The map that exists before a build, compared by its drives. Data that refer to a session by its
// index (labels, searched images) stay valid for the first sessions, if the same drives come first
// again. For others they would refer to another drive.

struct ExistingMap {
  Map map;
  std::size_t stay = 0;  ///< number of its first sessions whose drives are the new map's first ones

  /// Whether all its drives are the new map's first ones: it is built again, or extended.
  [[nodiscard]] bool goes_on() const { return stay == map.sessions.size(); }
  /// Names of the sessions from `first` on, joined by ", ".
  [[nodiscard]] std::string names(std::size_t first = 0) const;
};

/// Reads the map in `file`, which must exist, and compares it with the digests of the new drives.
/// Throws BadInput for a damaged map.
[[nodiscard]] ExistingMap read_existing_map(const std::filesystem::path& file,
                                            const std::vector<std::string>& digests);

/// Tables that the new map takes over: `always` those, and `of_drives` if it continues with all
/// drives. Reports those that it does not take.
[[nodiscard]] std::vector<std::string> tables_that_stay(const std::filesystem::path& file,
                                                        const ExistingMap& existing,
                                                        const std::vector<std::string>& always,
                                                        const std::vector<std::string>& of_drives,
                                                        std::vector<Problem>& warnings);

}  // namespace roadbook
