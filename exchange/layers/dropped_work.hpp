#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

/// A result that the previous map had and the new map lacks, with the command that makes it again.
struct DroppedWork {
  std::string name;  ///< "overhead image"
  std::vector<std::string> layers;
  std::string command;  ///< empty: no verb of roadbook made these layers
};

/// Groups dropped layers and tables (`MapSummary::dropped`) by the result they belong to, in the
/// order of the commands to run.
[[nodiscard]] std::vector<DroppedWork> dropped_work(const std::vector<std::string>& layers,
                                                    const std::filesystem::path& map);

/// Returns one warning for each.
[[nodiscard]] std::vector<Problem> dropped_warnings(const std::vector<DroppedWork>& dropped,
                                                    const std::filesystem::path& map);

}  // namespace roadbook
