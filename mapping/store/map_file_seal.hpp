#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace roadbook {

/// Declares the file complete: styles of its layers, state, digests, SQLite's own check. The last
/// change to a file.
void seal_map_file(const std::filesystem::path& path);

/// Action and detail of a line of the history (`audit`).
using AuditLine = std::pair<std::string, std::string>;

/// Seals `copy`, a changed copy of `map`, with lines in its history. Returns false if the copy has
/// the content of the map: nothing was changed, and the lines are left out.
[[nodiscard]] bool seal_changed_copy(const std::filesystem::path& copy,
                                     const std::filesystem::path& map,
                                     const std::vector<AuditLine>& lines);

}  // namespace roadbook
