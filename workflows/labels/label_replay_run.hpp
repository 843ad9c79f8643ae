#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "base/messages.hpp"

namespace roadbook {

/// Repeats the rounds of a map's labelling page from its list of events. Reports for each round
/// whether the repetition gives the same classifier as the page had. Rounds about people read
/// images: `drives` are the folders of drives that have moved from the path stored in the map. The
/// map does not change. Returns the result that `--json` prints: `rounds`, `people`, and `same`
/// (false if a classifier differs). Throws BadInput.
[[nodiscard]] nlohmann::ordered_json run_replay(const std::filesystem::path& map,
                                                const std::vector<std::filesystem::path>& drives,
                                                int num_threads,
                                                const Messages& messages);

}  // namespace roadbook
