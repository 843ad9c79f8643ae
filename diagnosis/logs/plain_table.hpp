#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/yaml.hpp"
#include "drive/problem_list.hpp"

namespace roadbook {

/// How a log's table is written. In YAML: file, separator, header, comment, skip_lines, matrix; of
/// streams and at the top drop_repeats as well (plain_streams.hpp, plain_log.cpp).
struct TableFormat {
  std::filesystem::path file;
  std::string separator = ",";  ///< one character, or "whitespace" (runs of it)
  bool header = true;           ///< first line names the columns; a comment mark before is dropped
  std::string comment = "#";    ///< lines that begin with it are skipped
  int skip_lines = 0;           ///< before the header
  std::string matrix;           ///< of a MATLAB file; then the rest does not matter
  bool drop_repeats = false;    ///< drops rows whose stamp is that of the row before
  /// Every file that this format and its copies were read for, in order.
  std::shared_ptr<std::vector<std::filesystem::path>> files_named =
      std::make_shared<std::vector<std::filesystem::path>>();

  /// Reads what `yaml` says, the rest kept; `folder`: of relative files.
  void read(YamlMap& yaml, const std::filesystem::path& folder);
};

/// SHA-256 of a log's description and of all files that it named, once each in order: `common` is
/// the format of which those of its streams are copies.
[[nodiscard]] std::string digest_of(const std::filesystem::path& description,
                                    const TableFormat& common);

/// All rows of a text table; rows with too few fields stay as they are.
struct LogTable {
  std::string file;
  std::int64_t header_line = 0;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::int64_t> lines;  ///< of each row
  std::string hint;                 ///< for messages: what else seems to separate the fields
};

/// Reports a file that is absent or has no row.
[[nodiscard]] LogTable read_plain_table(const TableFormat& format, ProblemList& problems);

/// One column as numbers, `unit` factor applied: value * factor + offset. `column` is a name or a
/// number from 1. Faults are reported with the first line and how many are alike; then the result
/// is short or empty.
struct ColumnUse {
  std::string column;
  std::string field;  ///< for messages: "poses.x"
  double factor = 1.0;
  double offset = 0.0;  ///< [SI], added last
};
[[nodiscard]] std::vector<double> numbers_of(const LogTable& table,
                                             const ColumnUse& use,
                                             ProblemList& problems);

/// For a line about the first of `count` faulty rows: " and 8 more such rows"; empty of one.
[[nodiscard]] std::string and_more_rows(std::size_t count);

}  // namespace roadbook
