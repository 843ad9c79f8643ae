#include "drive/table_faults.hpp"

#include <algorithm>

#include "base/text.hpp"

namespace roadbook {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

// Without what stands in square brackets: "timestamp [rad s^-1]" has a blank only inside its unit,
// and one before it.
std::string without_units(std::string_view line) {
  std::string text;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::size_t close = line[i] == '[' ? line.find(']', i) : std::string_view::npos;
    if (close == std::string_view::npos) {
      text += line[i];
      continue;
    }
    while (!text.empty() && text.back() == ' ') text.pop_back();
    i = close;
  }
  return text;
}

}  // namespace

std::string encoding_fault(std::string_view line) {
  if (line.starts_with("\xFF\xFE") || line.starts_with("\xFE\xFF") ||
      line.find('\0') != std::string_view::npos)
    return "UTF-16 text";
  const auto end = line.find('\r');
  if (end != std::string_view::npos && end + 1 < line.size() && line[end + 1] != '\r')
    return "line ends of CR alone";
  return "";
}

std::string layout_fault(std::string_view line, char separator, std::size_t got, std::size_t want) {
  const auto has = [](std::string_view text, char c) {
    return text.find(c) != std::string_view::npos;
  };
  if (has(line, '"')) return "quotes around them";
  if (got == 1) {
    const std::string text = without_units(trim(line));
    for (const char other : {';', '\t', '|', ',', ' '})
      if (other != separator && has(trim(text), other))
        return separator_name(other) + " between them";
  }
  if (separator == ',' && want > 2 && got >= 2 * want - 1) return "decimal commas?";
  return "";
}

std::string separator_name(char separator) {
  switch (separator) {
    case ',':
      return "commas";
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    case ' ':
      return "blanks";
    case '|':
      return "bars";
    default:
      return std::string("'") + separator + "'";
  }
}

std::string in_brackets(const std::string& text) { return text.empty() ? "" : " (" + text + ")"; }

std::string number_wanted(std::string_view text) {
  const std::string want = "a finite number";
  if (std::count(text.begin(), text.end(), ',') != 1) return want;
  std::string with_point(text);
  with_point[with_point.find(',')] = '.';
  return parse_double(with_point) ? want + " with a point, not a comma, before its decimals" : want;
}

std::vector<std::string_view> split_at_blanks(std::string_view line) {
  std::vector<std::string_view> fields;
  for (auto begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const auto end = line.find_first_of(kBlanks, begin);
    fields.push_back(line.substr(begin, end == std::string_view::npos ? end : end - begin));
    begin = end == std::string_view::npos ? end : line.find_first_not_of(kBlanks, end);
  }
  return fields;
}

}  // namespace roadbook
