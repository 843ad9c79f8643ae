#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// Writes `text` to `file`, whole or not at all (through FILE.part); what is no regular file, a
/// device or a pipe, is written to as it stands. Throws StorageError.
void write_file(const std::filesystem::path& file, const std::string& text);

/// Throws InvalidOption for an output that is the map it is made from: writing it would destroy it.
void refuse_to_replace(const std::filesystem::path& map, const std::filesystem::path& output);

}  // namespace roadbook
