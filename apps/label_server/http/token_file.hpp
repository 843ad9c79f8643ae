#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// The token in `file`, or a new one that is written there, readable by its owner alone: with it
/// the address stays the same when the server is started again. Throws BadInput for a file that
/// others may read or that holds no token; StorageError.
[[nodiscard]] std::string kept_token(const std::filesystem::path& file);

}  // namespace roadbook
