#pragma once

#include <filesystem>

namespace roadbook {

/// Throws InvalidOption if `output` is the map itself, because the output would overwrite the map.
void refuse_to_replace(const std::filesystem::path& map, const std::filesystem::path& output);

}  // namespace roadbook
