#pragma once

#include <string>

#include "diagnosis/logs/plain_table.hpp"

namespace roadbook {

/// A real matrix of a MATLAB file (version 5, compressed or not) as a table without names; its rows
/// count as lines. Reports a file or a matrix that cannot be read.
[[nodiscard]] LogTable read_matrix_table(const std::filesystem::path& file,
                                         const std::string& matrix,
                                         ProblemList& problems);

}  // namespace roadbook
