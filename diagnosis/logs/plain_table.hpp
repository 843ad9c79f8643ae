#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/yaml.hpp"
#include "drive/problem_list.hpp"

namespace roadbook {

/// Format of a table. Keys in the YAML: file, separator, header, comment, skip_lines, matrix; for
/// streams and at the top level also drop_repeats (plain_streams.hpp, plain_log.cpp).
struct TableFormat {
  std::filesystem::path file;
  std::string separator = ",";  ///< one character, or "whitespace" (runs of it)
  bool header = true;  ///< the first line names the columns; a leading comment mark is dropped
  std::string comment = "#";  ///< lines that begin with it are skipped
  int skip_lines = 0;         ///< lines before the header
  std::string matrix;         ///< name of the matrix in a MATLAB file; other keys are then ignored
  bool drop_repeats = false;  ///< drops rows with the stamp of the previous row
  /// All files read with this format and its copies, in order.
  std::shared_ptr<std::vector<std::filesystem::path>> files_named =
      std::make_shared<std::vector<std::filesystem::path>>();
  /// Stamp [s] at which the clock of this format and its copies begins; empty before the first.
  std::shared_ptr<std::optional<double>> clock_begin_s = std::make_shared<std::optional<double>>();

  /// Returns the time [s] since the clock began, in whole microseconds, so that a shift of all
  /// stamps changes nothing: the last digits of times decide whether a knot of the fit falls on a
  /// reading. The first call begins the clock.
  [[nodiscard]] double since_begin(double stamp_s) const;

  /// Reads the keys given in `yaml`; others keep their values. `folder`: base of relative paths.
  void read(YamlMap& yaml, const std::filesystem::path& folder);
};

/// SHA-256 of a description and of all files that it names, each once, in order. `common`: the
/// format from which those of the streams were copied.
[[nodiscard]] std::string digest_of(const std::filesystem::path& description,
                                    const TableFormat& common);

/// All rows of a text table. Rows with too few fields are kept unchanged.
struct LogTable {
  std::string file;
  std::int64_t header_line = 0;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::int64_t> lines;  ///< line number of each row
  std::string hint;                 ///< for messages: the separator that the file seems to use
};

/// Reads a table. Reports a file that is missing or has no rows.
[[nodiscard]] LogTable read_plain_table(const TableFormat& format, ProblemList& problems);

/// Reads one column as numbers: value * factor + offset. `column` is a name or a number from 1.
/// Faults are reported once, with the first line and their count; the result is then short or
/// empty.
struct ColumnUse {
  std::string column;
  std::string field;  ///< for messages: "poses.x"
  double factor = 1.0;
  double offset = 0.0;  ///< [SI unit], added last
};
[[nodiscard]] std::vector<double> numbers_of(const LogTable& table,
                                             const ColumnUse& use,
                                             ProblemList& problems);

/// Text after a report of the first of `count` faulty rows: " and 8 more such rows"; empty for one.
[[nodiscard]] std::string and_more_rows(std::size_t count);

}  // namespace roadbook
