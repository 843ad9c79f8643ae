#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "drive/import/import_options.hpp"

namespace roadbook {

// Recordings of other layouts, rewritten as drives. docs/reference/drive_format.md says for each
// format what is read, and which frames and sizes are assumed because the source does not state
// them.

/// "comma2k19", "euroc", "kaist", "kitti", "kitti360", "video".
[[nodiscard]] const std::vector<std::string>& import_formats();

/// Writes `source` as a drive to `out`. Throws BadInput for an unknown format (naming the nearest)
/// and for a source that cannot be used, StorageError where writing fails.
ImportResult import_drive(const std::string& format,
                          const std::filesystem::path& source,
                          const std::filesystem::path& out,
                          const ImportOptions& options = {},
                          const Progress& progress = {});

}  // namespace roadbook
