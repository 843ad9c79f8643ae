#pragma once

#include <filesystem>

#include "base/yaml.hpp"
#include "diagnosis/logs/plain_log.hpp"
#include "diagnosis/logs/plain_table.hpp"

namespace roadbook {

/// The sections `scans`, `beacons` and `friction` of a plain log's description, at the poses that
/// `log` has already (docs/reference/plain_logs.md). Clock as in the files.
void read_plain_readings(YamlMap& yaml,
                         const TableFormat& common,
                         const std::filesystem::path& folder,
                         ProblemList& problems,
                         PlainLog& log);

}  // namespace roadbook
