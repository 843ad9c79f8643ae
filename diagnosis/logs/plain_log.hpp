#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// Logs of any car as diagnosis wants them: a YAML says which file and column is what
// (docs/reference/plain_logs.md). One clock for all streams; its zero is put at the first pose.

struct PlainLog {
  std::string name;
  MotionStreams streams;
  DriveReadings readings;            ///< ranges and friction on the way
  std::vector<std::string> notes;    ///< what was derived, dropped or assumed, in words
  std::vector<std::string> without;  ///< effects that cannot be in poses so measured
  std::string digest;                ///< SHA-256 of the description and the files it names
};

/// Reads `description` and the files it names (relative to it, or to its `folder`). Throws BadInput
/// with every fault: file, line, field, what was found and what is wanted. Linear in the files.
[[nodiscard]] PlainLog read_plain_log(const std::filesystem::path& description);

}  // namespace roadbook
