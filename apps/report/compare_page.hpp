#pragma once

#include <filesystem>
#include <string>

#include "workflows/compare/compare_files.hpp"

namespace roadbook {

/// Returns the comparison of two map files as one self-contained HTML document: its numbers, both
/// maps from above after the motion of B onto A, the worst place and the landmarks that differ.
[[nodiscard]] std::string compare_page(const FileComparison& comparison,
                                       const std::filesystem::path& a,
                                       const std::filesystem::path& b);

}  // namespace roadbook
