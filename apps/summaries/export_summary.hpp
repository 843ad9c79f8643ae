#pragma once

#include <string>

#include "apps/console.hpp"
#include "workflows/export_place.hpp"

namespace roadbook {

/// Prints the files that `export` wrote and the objects that they omit. With `--json`, prints one
/// object.
void print_export(const Console& console, const ExportResult& result, const std::string& format);

}  // namespace roadbook
