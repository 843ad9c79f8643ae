#pragma once

#include <filesystem>
#include <vector>

#include "apps/options.hpp"

namespace roadbook {

/// Declares `--drive` for a verb that reads the drives of a map's sessions.
void add_drive_option(Options& options, std::vector<std::filesystem::path>* drives);

}  // namespace roadbook
