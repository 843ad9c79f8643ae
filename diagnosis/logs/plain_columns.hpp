#pragma once

#include <filesystem>

#include "base/yaml.hpp"
#include "diagnosis/logs/plain_log.hpp"
#include "diagnosis/logs/plain_table.hpp"

namespace roadbook {

/// The list `covariates` of a plain log's description: further columns that a sensor may depend on
/// (docs/reference/plain_logs.md). Clock as in the files. After the streams and readings: names that these
/// bring with them are taken.
void read_plain_columns(YamlMap& yaml,
                        const TableFormat& common,
                        const std::filesystem::path& folder,
                        ProblemList& problems,
                        PlainLog& log);

}  // namespace roadbook
