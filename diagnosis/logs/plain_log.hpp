#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// Reads logs of any vehicle for diagnosis. A YAML description says which file and column holds what
// (docs/reference/plain_logs.md). All streams share one clock, whose zero is the first pose.

struct PlainLog {
  std::string name;
  MotionStreams streams;
  DriveReadings readings;            ///< ranges and friction readings at the poses
  std::vector<std::string> notes;    ///< text: what was derived, dropped or assumed
  std::vector<std::string> without;  ///< effects that poses of this kind cannot have
  std::string digest;                ///< SHA-256 of the description and the files it names
};

/// Reads `description` and the files it names, relative to it or to its `folder`. Throws BadInput
/// with all faults: file, line, field, what was found and what is expected. Linear in the size of
/// the files.
[[nodiscard]] PlainLog read_plain_log(const std::filesystem::path& description);

}  // namespace roadbook
