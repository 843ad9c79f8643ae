#include "apps/evaluation/robustness/recorded_table.hpp"

#include <array>
#include <charconv>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw BadInput({Severity::kError, file.string(), 0, "", "unreadable", "a text file"});
  return text.str();
}

std::string shortest(double value) {
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields;
  for (const std::string_view field : split(line)) fields.emplace_back(field);
  return fields;
}

}  // namespace

RecordedTable::RecordedTable(std::filesystem::path file) : file_(std::move(file)) {
  std::istringstream lines(text_of(file_));
  std::string line;
  if (!std::getline(lines, header_) || !header_.starts_with('#'))
    throw BadInput(
        {Severity::kError, file_.string(), 1, "header", "none", "'#timestamp [ns],...'"});
  names_ = fields_of(std::string_view(header_).substr(1));
  while (std::getline(lines, line))
    if (!trim(line).empty()) cells_.push_back(fields_of(line));
}

std::size_t RecordedTable::column(std::string_view name) const {
  for (std::size_t i = 0; i < names_.size(); ++i)
    if (names_[i].starts_with(name)) return i;
  throw BadInput({Severity::kError, file_.string(), 1, "header", "no column " + std::string(name),
                  "one of that name"});
}

std::string& RecordedTable::cell(std::size_t row, std::size_t column) {
  return cells_.at(row).at(column);
}

const std::string& RecordedTable::cell(std::size_t row, std::size_t column) const {
  return cells_.at(row).at(column);
}

double RecordedTable::number(std::size_t row, std::size_t column) const {
  const std::string& text = cells_.at(row).at(column);
  if (const auto value = parse_double(text)) return *value;
  throw BadInput({Severity::kError, file_.string(), static_cast<std::int64_t>(row) + 2,
                  names_.at(column), "'" + text + "'", "a number"});
}

void RecordedTable::set(std::size_t row, std::size_t column, double value) {
  cell(row, column) = shortest(value);
}

std::int64_t RecordedTable::stamp_ns(std::size_t row) const {
  return parse_int(cells_.at(row).at(0)).value_or(0);
}

void RecordedTable::shift_stamps(std::int64_t ns) {
  for (std::size_t row = 0; row < rows(); ++row) cell(row, 0) = std::to_string(stamp_ns(row) + ns);
}

void RecordedTable::write() const {
  std::string text = header_ + "\n";
  for (const auto& row : cells_) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + row[i];
    text += "\n";
  }
  write_whole_file(file_, text);
}

void set_value(const std::filesystem::path& sensor_yaml,
               const std::string& key,
               const std::string& value) {
  std::istringstream lines(text_of(sensor_yaml));
  std::string line;
  std::string text;
  bool is_found = false;
  while (std::getline(lines, line)) {
    const std::size_t start = line.find_first_not_of(' ');
    if (start != std::string::npos && line.compare(start, key.size() + 1, key + ":") == 0) {
      line = line.substr(0, start) + key + ": " + value;
      is_found = true;
    }
    text += line + "\n";
  }
  if (!is_found)
    throw BadInput({Severity::kError, sensor_yaml.string(), 0, key, "no such key", "a value"});
  write_whole_file(sensor_yaml, text);
}

std::string value_of(const std::filesystem::path& sensor_yaml, const std::string& key) {
  std::istringstream lines(text_of(sensor_yaml));
  std::string line;
  while (std::getline(lines, line)) {
    const std::string_view trimmed = trim(line);
    if (trimmed.starts_with(key + ":")) return std::string(trim(trimmed.substr(key.size() + 1)));
  }
  throw BadInput({Severity::kError, sensor_yaml.string(), 0, key, "no such key", "a value"});
}

std::vector<double> numbers_of(const std::string& list) {
  std::vector<double> numbers;
  std::string_view inner = trim(list);
  if (inner.starts_with('[')) inner.remove_prefix(1);
  if (inner.ends_with(']')) inner.remove_suffix(1);
  for (const std::string_view field : split(inner)) {
    const auto number = parse_double(field);
    if (!number)
      throw BadInput({Severity::kError, "", 0, "list", "'" + std::string(field) + "'", "a number"});
    numbers.push_back(*number);
  }
  return numbers;
}

std::string list_of(const std::vector<double>& numbers) {
  std::string list;
  for (const double number : numbers) list += (list.empty() ? "[" : ", ") + shortest(number);
  return list + "]";
}

}  // namespace roadbook
