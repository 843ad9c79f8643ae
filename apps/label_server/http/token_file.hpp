#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// Returns the token in `file`. If the file does not exist, writes a new token that only its owner
/// may read. With the file, the address stays the same after a restart of the server. Throws
/// BadInput if others may read the file or if it holds no token, and StorageError.
[[nodiscard]] std::string kept_token(const std::filesystem::path& file);

}  // namespace roadbook
