#pragma once

#include <string>

namespace roadbook {

/// Returns hex digits that identify the program that runs: the build ids of the executable and of
/// roadbook's own shared libraries, or the digest of the executable where it has no build id. Two
/// runs of one binary have the same digits. Throws StorageError if the executable cannot be read.
[[nodiscard]] std::string program_digest();

}  // namespace roadbook
