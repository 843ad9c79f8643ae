#pragma once

#include <filesystem>
#include <vector>

#include "apps/console.hpp"

namespace roadbook {

/// Repeats the rounds of a map's labelling page from its list of events. Reports for each round
/// whether the repetition gives the same classifier as the page had. Rounds about people read
/// images: `drives` are the folders of drives that have moved from the path stored in the map. The
/// map does not change. Returns false if a classifier differs. Throws BadInput.
[[nodiscard]] bool run_replay(const std::filesystem::path& map,
                              const std::vector<std::filesystem::path>& drives,
                              int num_threads,
                              Console& console);

}  // namespace roadbook
