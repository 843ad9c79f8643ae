#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

/// Work that a map had and the map in its place has not, and the command that does it again.
struct DroppedWork {
  std::string name;  ///< "overhead image"
  std::vector<std::string> layers;
  std::string command;  ///< empty: no verb of roadbook made these layers
};

/// Layers and tables (`MapSummary::dropped`) by the work they belong to, in the order in which the
/// commands are to be given.
[[nodiscard]] std::vector<DroppedWork> dropped_work(const std::vector<std::string>& layers,
                                                    const std::filesystem::path& map);

/// A warning for each.
[[nodiscard]] std::vector<Problem> dropped_warnings(const std::vector<DroppedWork>& dropped,
                                                    const std::filesystem::path& map);

}  // namespace roadbook
