#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// The map that is there before a build, by its drives. What hangs on a session by its place in the
// list (labels, images looked through) stays where it was for the first ones that are made of the
// same drives again; of the others it would come to hang on another drive.

struct ExistingMap {
  Map map;
  std::size_t stay = 0;  ///< its first sessions of which the drives are the new map's first ones

  /// Whether all its drives are the new map's first ones: it is built again, or extended.
  [[nodiscard]] bool goes_on() const { return stay == map.sessions.size(); }
  /// Names of the sessions from `first` on, joined by ", ".
  [[nodiscard]] std::string names(std::size_t first = 0) const;
};

/// The map in `file`, which must exist, beside the digests of the drives of the new one. Throws
/// BadInput for a map that is damaged.
[[nodiscard]] ExistingMap read_existing_map(const std::filesystem::path& file,
                                            const std::vector<std::string>& digests);

/// Of tables that outlive a build, those that the new map takes over: `always` those, and
/// `of_drives` where it goes on with all drives. What is left out is told.
[[nodiscard]] std::vector<std::string> tables_that_stay(const std::filesystem::path& file,
                                                        const ExistingMap& existing,
                                                        const std::vector<std::string>& always,
                                                        const std::vector<std::string>& of_drives,
                                                        std::vector<Problem>& warnings);

}  // namespace roadbook
