#pragma once

#include <filesystem>

namespace roadbook {

/// Throws InvalidOption if the file `output` of `option` is the map itself, because the output
/// would overwrite the map.
void refuse_to_replace(const std::filesystem::path& map,
                       const std::filesystem::path& output,
                       const char* option = "--output");

}  // namespace roadbook
