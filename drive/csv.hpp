#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/text_file.hpp"
#include "drive/problem_list.hpp"

namespace roadbook {

/// Reads a text file line by line in a fixed amount of memory. CRLF and a UTF-8 byte order mark are
/// removed. A line longer than 64 KiB ends the reading: such a file is no table.
class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& file);
  [[nodiscard]] bool is_open() const { return static_cast<bool>(file_); }
  /// Why the file is not open: "no readable file", "a pipe", ...
  [[nodiscard]] const std::string& fault() const { return file_.fault(); }
  /// The next line, valid until the next call; empty at the end.
  std::optional<std::string_view> next();
  [[nodiscard]] std::int64_t line() const { return line_; }
  [[nodiscard]] bool too_long() const { return too_long_; }

 private:
  bool refill();
  RegularFile file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::int64_t line_ = 0;
  bool too_long_ = false;
};

/// One column of a table: "rear_left_angle [rad]" has the name rear_left_angle and the unit rad.
struct CsvColumn {
  std::string name;
  std::string unit;
};

enum class CsvHeader {
  kRequired,  ///< the first line names the columns, behind a `#`
  kIgnored,   ///< columns count by position; `#` lines are comments
};

/// A table of the drive format: a `#` header that names the columns, then rows of comma-separated
/// fields. Rows with a wrong number of fields are reported and skipped; blank lines and further
/// `#` lines are skipped.
class CsvReader {
 public:
  /// Reports to `problems` (which must outlive the reader) where the file or its header is bad.
  CsvReader(const std::filesystem::path& file, CsvHeader header, ProblemList& problems);

  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] const std::vector<CsvColumn>& columns() const { return columns_; }
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
  /// Column of `name`. Adds an error at the header's line where the column is absent or its unit is
  /// not among `units` (separated by '|'; "" means no unit).
  std::optional<std::size_t> require(std::string_view name, std::string_view units);

  bool next();
  [[nodiscard]] std::int64_t line() const { return lines_.line(); }
  /// Blank lines between the row before (or the header) and this one.
  [[nodiscard]] std::size_t blank_lines_before() const { return blank_lines_; }
  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
  /// The row's text from the file, without blanks at its ends; valid until the next row is read.
  [[nodiscard]] std::string_view text() const { return row_; }
  [[nodiscard]] const std::string& file() const { return name_; }

  /// The field as a finite number or a stamp; else an error at this line and nothing.
  std::optional<double> number(std::size_t column);
  std::optional<std::int64_t> stamp(std::size_t column);

 private:
  void read_header();
  [[nodiscard]] std::string column_name(std::size_t column) const;

  std::string name_;
  ProblemList& problems_;
  LineReader lines_;
  bool good_ = true;
  std::vector<CsvColumn> columns_;
  std::int64_t header_line_ = 0;
  std::size_t blank_lines_ = 0;
  std::string_view row_;
  std::vector<std::string_view> fields_;
  bool by_position_ = false;
};

/// For messages: at most 60 characters, everything outside printable ASCII shown as '?'.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace roadbook
