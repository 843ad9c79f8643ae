#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// Returns who holds a lock of SQLite on `file`, or a lock on the whole of it (a folder): "process
/// 1234 (roadbook map a -m a.gpkg)", or "another process" where the system does not say (another
/// machine, another container).
[[nodiscard]] std::string lock_holder(const std::filesystem::path& file);

}  // namespace roadbook
