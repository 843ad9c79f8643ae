#pragma once

#include <filesystem>

#include "base/yaml.hpp"
#include "diagnosis/logs/plain_log.hpp"
#include "diagnosis/logs/plain_table.hpp"

namespace roadbook {

/// Reads the sections `scans`, `beacons` and `friction` of a plain log's description, at the poses
/// already in `log` (docs/reference/plain_logs.md). Stamps keep the clock of the files.
void read_plain_readings(YamlMap& yaml,
                         const TableFormat& common,
                         const std::filesystem::path& folder,
                         ProblemList& problems,
                         PlainLog& log);

}  // namespace roadbook
