#pragma once

#include <filesystem>
#include <vector>

#include "apps/console.hpp"

namespace roadbook {

/// Plays the rounds of a map's labelling page again from its list of events, and says of each
/// whether that gives the classifier which the page had. Rounds about people look into images:
/// `drives` are those of sessions that are not where the map says. The map is not changed. False
/// where a classifier is another. Throws BadInput.
[[nodiscard]] bool run_replay(const std::filesystem::path& map,
                              const std::vector<std::filesystem::path>& drives,
                              int num_threads,
                              Console& console);

}  // namespace roadbook
