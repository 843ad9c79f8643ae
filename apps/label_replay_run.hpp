#pragma once

#include <filesystem>

#include "apps/console.hpp"

namespace roadbook {

/// Plays the rounds of a map's labelling page again from its list of events, and says of each
/// whether that gives the classifier which the page had. The map is not changed. False where one is
/// another. Throws BadInput.
[[nodiscard]] bool run_replay(const std::filesystem::path& map, int num_threads, Console& console);

}  // namespace roadbook
