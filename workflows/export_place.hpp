#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "exchange/export/export_map.hpp"

namespace roadbook {

/// The arguments of `export_place`.
struct ExportRequest {
  std::filesystem::path map;
  std::string format;  ///< one of `export_formats()`
  std::filesystem::path output;
  ExportOptions options;
};

struct ExportResult {
  std::vector<std::filesystem::path> files;
  ExportNotes left_out;           ///< number of objects that the format cannot represent
  std::vector<Problem> warnings;  ///< labels without a place, and labels outside the image
  std::vector<std::string> rasters_left_out;  ///< layers that only GeoTIFF holds
};

/// Returns warnings about labels without a place in the map, for formats that hold labels. Call it
/// before the export, which may refuse the map.
[[nodiscard]] std::vector<Problem> labels_without_place(const ExportRequest& request);

/// Writes a map in the format of another program. Throws BadInput, InvalidOption, Refused,
/// StorageError.
[[nodiscard]] ExportResult export_place(const ExportRequest& request);

}  // namespace roadbook
