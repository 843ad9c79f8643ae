#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// Writes the bytes of `text` to `file` without conversion. Throws StorageError if that fails.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace roadbook
