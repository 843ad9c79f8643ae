#pragma once

#include <filesystem>

#include "apps/console.hpp"
#include "drive/check.hpp"
#include "drive/import/import.hpp"
#include "exchange/import/import_labels.hpp"

namespace roadbook {

/// Prints how many labels were stored, changed and left out, with reasons; with `--json` one
/// object.
void print_imported_labels(const Console& console,
                           const LabelImport& made,
                           const std::filesystem::path& map);

/// Prints the contents of the drive that was written. With `--json`, prints one object.
void print_imported_drive(const Console& console,
                          const ImportResult& made,
                          const DriveReport& report,
                          const std::filesystem::path& drive);

}  // namespace roadbook
