#include "diagnosis/logs/plain_table.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/digest.hpp"
#include "base/text.hpp"
#include "diagnosis/logs/plain_matrix.hpp"
#include "drive/csv.hpp"
#include "drive/table_faults.hpp"

namespace roadbook {
namespace {

std::vector<std::string> fields_of(std::string_view line, const std::string& separator) {
  std::vector<std::string> fields;
  if (separator != "whitespace") {
    for (const std::string_view f : split(line, separator.front())) fields.emplace_back(f);
    return fields;
  }
  for (const std::string_view f : split_at_blanks(line)) fields.emplace_back(f);
  return fields;
}

// Guesses the separator of a line that should have several fields and has one.
std::string layout_hint(const TableFormat& format, std::string_view line, std::size_t fields) {
  if (format.separator == "whitespace") return "";
  const std::string fault = layout_fault(line, format.separator.front(), fields, fields);
  if (fault.empty()) return "";
  return fault + ", but the description states separator: \"" +
         (format.separator == "\t" ? "tab" : format.separator) + "\"";
}

std::string all_names(const LogTable& table) {
  std::string names;
  for (const std::string& n : table.names) names += (names.empty() ? "" : ", ") + n;
  return names;
}

// Index of the column. Names take precedence: a header may name a column "1".
std::optional<std::size_t> find_column(const LogTable& table,
                                       const ColumnUse& use,
                                       ProblemList& problems) {
  const auto named = std::find(table.names.begin(), table.names.end(), use.column);
  if (named != table.names.end()) return static_cast<std::size_t>(named - table.names.begin());
  const auto number = parse_int(use.column);
  const std::size_t width = table.rows.front().size();
  if (number && *number >= 1 && static_cast<std::size_t>(*number) <= width)
    return static_cast<std::size_t>(*number - 1);
  const std::string want = table.names.empty() || number
                               ? "a column from 1 to " + std::to_string(width)
                               : "one of " + printable(all_names(table)) + ", or a number from 1";
  problems.error(table.file, table.header_line, use.field,
                 printable(use.column) + in_brackets(table.hint), want);
  return std::nullopt;
}

// Reports all rows without a number in one line, because a column of the wrong kind has only such
// rows.
void report_rows(const LogTable& table,
                 const ColumnUse& use,
                 std::size_t column,
                 const std::vector<std::size_t>& bad,
                 ProblemList& problems) {
  const std::vector<std::string>& row = table.rows[bad.front()];
  const bool there = column < row.size();
  std::string got = std::to_string(row.size()) + " fields";
  if (there) got = row[column].empty() ? "nothing" : "'" + printable(row[column]) + "'";
  if (!there || row.size() == 1) got += in_brackets(table.hint);
  problems.error(
      table.file, table.lines[bad.front()], use.field, got + and_more_rows(bad.size()),
      there ? number_wanted(row[column]) : "at least " + std::to_string(column + 1) + " fields");
}

}  // namespace

double TableFormat::since_begin(double stamp_s) const {
  constexpr double kPerSecond = 1e6;
  if (!*clock_begin_s) *clock_begin_s = stamp_s;
  return std::round((stamp_s - **clock_begin_s) * kPerSecond) / kPerSecond;
}

void TableFormat::read(YamlMap& yaml, const std::filesystem::path& folder) {
  std::string name;
  if (yaml.read("file", name)) {
    file = folder / name;
    files_named->push_back(file);
  }
  if (yaml.read("separator", separator)) {
    if (separator == "tab") separator = "\t";
    if (separator != "whitespace" && separator.size() != 1)
      yaml.report("separator", separator, "one character, tab or whitespace");
  }
  yaml.read("header", header);
  yaml.read("comment", comment);
  yaml.read("skip_lines", skip_lines, {0.0, 1e6});
  yaml.read("matrix", matrix);
}

std::string digest_of(const std::filesystem::path& description, const TableFormat& common) {
  Sha256 sum;
  sum.update_file(description);
  const auto& named = *common.files_named;
  std::error_code ignored;
  for (auto file = named.begin(); file != named.end(); ++file)
    if (std::find(named.begin(), file, *file) == file &&
        std::filesystem::is_regular_file(*file, ignored))
      sum.update_file(*file);
  return sum.hex();
}

LogTable read_plain_table(const TableFormat& format, ProblemList& problems) {
  if (!format.matrix.empty()) return read_matrix_table(format.file, format.matrix, problems);
  LogTable table;
  table.file = format.file.string();
  std::error_code error;
  LineReader lines(format.file);
  if (!std::filesystem::is_regular_file(format.file, error) || !lines.is_open()) {
    problems.error(table.file, 0, "", "a file that cannot be read", "a text table");
    return table;
  }
  bool header = format.header;
  while (const auto line = lines.next()) {
    std::string_view text = trim(*line);
    if (const auto fault = encoding_fault(*line); !fault.empty()) {
      problems.error(table.file, lines.line(), "", fault, "UTF-8 text");
      return LogTable{};
    }
    if (lines.line() <= format.skip_lines || text.empty()) continue;
    const bool marked = !format.comment.empty() && text.starts_with(format.comment);
    if (header) {
      if (marked) text.remove_prefix(format.comment.size());
      table.names = fields_of(text, format.separator);
      table.header_line = lines.line();
      table.hint = layout_hint(format, text, table.names.size());
      header = false;
    } else if (!marked) {
      table.rows.push_back(fields_of(text, format.separator));
      table.lines.push_back(lines.line());
      if (table.rows.size() == 1 && table.hint.empty())
        table.hint = layout_hint(format, text, table.rows.front().size());
    }
  }
  if (lines.too_long())
    problems.error(table.file, lines.line(), "", "a line longer than 64 KiB", "a text table");
  if (table.rows.empty())
    problems.error(table.file, 0, "rows", "none", "at least one row of numbers");
  return table;
}

std::string and_more_rows(std::size_t count) {
  return count > 1 ? " and " + std::to_string(count - 1) + " more such rows" : "";
}

std::vector<double> numbers_of(const LogTable& table, const ColumnUse& use, ProblemList& problems) {
  std::vector<double> values;
  if (table.rows.empty()) return values;
  const auto column = find_column(table, use, problems);
  if (!column) return values;
  values.reserve(table.rows.size());
  std::vector<std::size_t> bad;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    const auto number = *column < row.size() ? parse_double(row[*column]) : std::nullopt;
    if (number)
      values.push_back(*number * use.factor + use.offset);
    else
      bad.push_back(i);
  }
  if (!bad.empty()) report_rows(table, use, *column, bad, problems);
  return values;
}

}  // namespace roadbook
