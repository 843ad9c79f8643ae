#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// Returns why a write to `file` failed: "no space left on the device holding FOLDER" where `error`
/// (a value of errno; 0: unknown) says so or the device of the folder has no room; otherwise the
/// text of `error`, or "a failed write". To be called before the unfinished file is removed.
[[nodiscard]] std::string write_fault(const std::filesystem::path& file, int error = 0);

}  // namespace roadbook
