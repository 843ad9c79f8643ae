#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams.hpp"

namespace roadbook {

// Logs of any car as diagnosis wants them: a YAML says which file and column is what
// (docs/plain_logs.md). One clock for all streams; its zero is put at the first pose.

struct PlainLog {
  std::string name;
  MotionStreams streams;
  DriveReadings readings;            ///< ranges and friction on the way
  std::vector<std::string> notes;    ///< what was derived, dropped or assumed, in words
  std::vector<std::string> without;  ///< effects that this log's readings cannot carry
};

/// Reads `description` and the files it names (relative to it, or to its `folder`). Throws BadInput
/// with every fault: file, line, field, what was found and what is wanted. Linear in the files.
///
/// One speed for the whole vehicle becomes two wheels that stand together in the middle of the axle
/// (`kMiddleTrack`); what lives in their difference is listed in `without`.
[[nodiscard]] PlainLog read_plain_log(const std::filesystem::path& description);

/// Track of two wheels that stand for one speed.
inline constexpr double kMiddleTrack = 1e-4;

}  // namespace roadbook
