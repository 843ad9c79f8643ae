#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "drive/drive.hpp"

namespace roadbook {

/// What `roadbook check DRIVE` reports.
struct DriveReport {
  std::vector<Problem> problems;  ///< in the order found, capped per file
  std::vector<StreamSummary> streams;
  std::size_t frames = 0;  ///< instants with at least one image
  std::size_t cameras = 0;
  bool has_wheels = false;
  bool usable = false;  ///< no error among the problems
};

/// Validates a drive as Drive::open does (some microseconds an image file, nothing decoded). Never
/// throws for bad input: the report lists every fault.
[[nodiscard]] DriveReport check_drive(const std::filesystem::path& folder,
                                      const DriveOptions& options = {});

}  // namespace roadbook
