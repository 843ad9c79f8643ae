#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// Writes `text` to `file`, byte by byte as it is. Throws StorageError where the disk does not take
/// it.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace roadbook
