#include "drive/csv.hpp"

#include <algorithm>
#include <cstring>

#include "base/text.hpp"
#include "drive/table_faults.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMaxLine = 64u << 10;
constexpr std::int64_t kLastStamp_ns = 9'000'000'000'000'000'000;  // room for offsets of clocks
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

CsvColumn parse_column(std::string_view text) {
  const auto open = text.find('[');
  const auto close = text.rfind(']');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open)
    return {std::string(trim(text)), ""};
  return {std::string(trim(text.substr(0, open))),
          std::string(trim(text.substr(open + 1, close - open - 1)))};
}

void split_into(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t begin = 0;;) {
    const auto comma = line.find(',', begin);
    const auto length = comma == std::string_view::npos ? comma : comma - begin;
    fields.push_back(trim(line.substr(begin, length)));
    if (comma == std::string_view::npos) return;
    begin = comma + 1;
  }
}

}  // namespace

LineReader::LineReader(const std::filesystem::path& file) : file_(file), buffer_(2 * kMaxLine) {}

bool LineReader::refill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t got = std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_.get());
  end_ += got;
  return got > 0;
}

std::optional<std::string_view> LineReader::next() {
  if (!file_ || too_long_) return std::nullopt;
  for (;;) {
    const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
    const auto newline = rest.find('\n');
    if (newline == std::string_view::npos && rest.size() <= kMaxLine && refill()) continue;
    if (rest.empty()) return std::nullopt;
    ++line_;
    std::string_view text = rest.substr(0, newline);
    if (text.size() > kMaxLine) {
      too_long_ = true;
      return std::nullopt;
    }
    begin_ += newline == std::string_view::npos ? rest.size() : newline + 1;
    if (line_ == 1 && text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }
}

CsvReader::CsvReader(const std::filesystem::path& file, CsvHeader header, ProblemList& problems)
    : name_(file.string()),
      problems_(problems),
      lines_(file),
      by_position_(header == CsvHeader::kIgnored) {
  if (!lines_.is_open()) {
    good_ = false;
    problems_.error(name_, 0, "", lines_.fault(), "a table");
  } else if (!by_position_) {
    read_header();
  }
}

void CsvReader::read_header() {
  std::optional<std::string_view> text = lines_.next();
  while (text && trim(*text).empty()) text = lines_.next();
  header_line_ = std::max<std::int64_t>(lines_.line(), 1);
  const auto refuse = [&](const std::string& got, const std::string& want) {
    good_ = false;
    problems_.error(name_, header_line_, "header", got, want);
  };
  if (text && !encoding_fault(*text).empty()) return refuse(encoding_fault(*text), "UTF-8 text");
  if (!text || !trim(*text).starts_with('#'))
    return refuse(text ? printable(*text) + in_brackets(layout_fault(*text, ',', 1, 1)) : "nothing",
                  "a line like '#timestamp [ns],...'");
  const std::string_view names = trim(trim(*text).substr(1));
  const std::size_t count = split(names).size();
  if (const auto fault = layout_fault(names, ',', count, count); !fault.empty())
    return refuse(printable(*text) + in_brackets(fault), "columns with commas between them");
  for (const auto field : split(trim(*text).substr(1))) columns_.push_back(parse_column(field));
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const auto before = find(columns_[i].name);
    if (before == i) continue;
    good_ = false;
    problems_.error(name_, header_line_, "header",
                    "column " + printable(columns_[i].name) + " twice", "each column once");
  }
}

std::optional<std::size_t> CsvReader::find(std::string_view name) const {
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (columns_[i].name == name) return i;
  return std::nullopt;
}

std::optional<std::size_t> CsvReader::require(std::string_view name, std::string_view units) {
  const auto column = find(name);
  const auto accepted = split(units, '|');
  if (!column) {
    std::vector<std::string> known;
    for (const auto& c : columns_) known.push_back(c.name);
    const auto near = nearest_name(name, known);
    problems_.error(name_, header_line_, "header",
                    near ? "column " + printable(*near) : "no such column",
                    std::string(name) + " [" + std::string(accepted.front()) + "]");
  } else if (std::find(accepted.begin(), accepted.end(), columns_[*column].unit) !=
             accepted.end()) {
    return column;
  } else {
    problems_.error(name_, header_line_, std::string(name),
                    "unit [" + printable(columns_[*column].unit) + "]",
                    "[" + std::string(accepted.front()) + "]");
  }
  good_ = false;
  return std::nullopt;
}

bool CsvReader::next() {
  if (!good_) return false;
  blank_lines_ = 0;
  while (const auto text = lines_.next()) {
    const std::string_view row = trim(*text);
    if (row.empty()) ++blank_lines_;
    if (row.empty() || row.front() == '#') continue;
    row_ = row;
    split_into(row, fields_);
    if (by_position_ || fields_.size() == columns_.size()) return true;
    problems_.error(name_, line(), "row",
                    std::to_string(fields_.size()) + " fields" +
                        in_brackets(layout_fault(row, ',', fields_.size(), columns_.size())),
                    std::to_string(columns_.size()) + " as the header names");
  }
  if (lines_.too_long()) {
    good_ = false;
    problems_.error(name_, line(), "", "a line longer than 64 KiB", "a table");
  }
  return false;
}

std::string CsvReader::column_name(std::size_t column) const {
  if (column < columns_.size()) return columns_[column].name;
  return "column " + std::to_string(column + 1);
}

std::optional<double> CsvReader::number(std::size_t column) {
  const auto value = parse_double(fields_[column]);
  if (!value)
    problems_.error(name_, line(), column_name(column), printable(fields_[column]),
                    "a finite number");
  return value;
}

std::optional<std::int64_t> CsvReader::stamp(std::size_t column) {
  const auto value = parse_int(fields_[column]);
  if (value && *value >= 0 && *value <= kLastStamp_ns) return value;
  problems_.error(
      name_, line(), by_position_ ? "timestamp" : column_name(column), printable(fields_[column]),
      value && *value > 0 ? "nanoseconds before the year 2255" : "whole nanoseconds >= 0");
  return std::nullopt;
}

std::string printable(std::string_view text) {
  constexpr std::size_t kMax = 60;
  std::string shown(text.substr(0, kMax));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  if (text.size() > kMax) shown += "...";
  return shown.empty() ? "nothing" : shown;
}

}  // namespace roadbook
