#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// Writes `text` to `file`, whole or not at all (through FILE.part). Throws StorageError.
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace roadbook
