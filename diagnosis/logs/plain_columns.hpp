#pragma once

#include <filesystem>

#include "base/yaml.hpp"
#include "diagnosis/logs/plain_log.hpp"
#include "diagnosis/logs/plain_table.hpp"

namespace roadbook {

/// Reads the list `covariates` of a plain log's description: further columns that a sensor may
/// depend on (docs/reference/plain_logs.md). Stamps keep the clock of the files. Call it after
/// streams and readings, whose names are reserved.
void read_plain_columns(YamlMap& yaml,
                        const TableFormat& common,
                        const std::filesystem::path& folder,
                        ProblemList& problems,
                        PlainLog& log);

}  // namespace roadbook
