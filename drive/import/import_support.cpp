#include "drive/import/import_support.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "base/se3.hpp"
#include "base/text.hpp"
#include "drive/csv.hpp"
#include "drive/table_faults.hpp"

namespace roadbook {

namespace fs = std::filesystem;

namespace {

std::string percent(double share) {
  std::ostringstream text;
  text.precision(3);
  text << 100.0 * share << " %";
  return text.str();
}

}  // namespace

std::optional<std::int64_t> seconds_to_ns(std::string_view text) {
  constexpr std::int64_t kMaxDigits = 18;
  text = trim(text);
  std::int64_t exponent = 0;
  if (const auto e = text.find_first_of("eE"); e != std::string_view::npos) {
    const auto value = parse_int(text.substr(e + 1));
    if (!value || *value < -30 || *value > 30) return std::nullopt;
    exponent = *value;
    text = text.substr(0, e);
  }
  const auto point = text.find('.');
  std::string digits(text.substr(0, point));
  std::int64_t decimals = 0;
  if (point != std::string_view::npos) {
    digits += text.substr(point + 1);
    decimals = static_cast<std::int64_t>(text.size() - point - 1);
  }
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  // digits * 10^(exponent - decimals) seconds are digits * 10^shift nanoseconds.
  const std::int64_t shift = 9 + exponent - decimals;
  bool round_up = false;
  if (shift >= 0) {
    digits.append(static_cast<std::size_t>(shift), '0');
  } else {
    const auto cut = static_cast<std::size_t>(-shift);
    digits.insert(0, cut + 1, '0');
    round_up = digits[digits.size() - cut] >= '5';
    digits.resize(digits.size() - cut);
  }
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
  if (static_cast<std::int64_t>(digits.size()) > kMaxDigits + 1) return std::nullopt;
  const auto ns = parse_int(digits);
  if (!ns || *ns > 9'000'000'000'000'000'000) return std::nullopt;
  return *ns + (round_up ? 1 : 0);
}

std::optional<std::int64_t> date_to_ns(std::string_view text) {
  text = trim(text);
  // YYYY-MM-DD HH:MM:SS.fffffffff
  if (text.size() < 19 || text[4] != '-' || text[7] != '-' || text[13] != ':' || text[16] != ':')
    return std::nullopt;
  const auto year = parse_int(text.substr(0, 4));
  const auto month = parse_int(text.substr(5, 2));
  const auto day = parse_int(text.substr(8, 2));
  const auto hour = parse_int(text.substr(11, 2));
  const auto minute = parse_int(text.substr(14, 2));
  const auto second_ns = seconds_to_ns(text.substr(17));
  constexpr std::int64_t kMinute_ns = 61'000'000'000;  // with a leap second
  if (!year || !month || !day || !hour || !minute || !second_ns || *second_ns >= kMinute_ns)
    return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok() || *hour < 0 || *hour > 23 || *minute < 0 || *minute > 59) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  if (days < 0 || days > 100'000) return std::nullopt;
  return ((days * 24 + *hour) * 60 + *minute) * 60 * 1'000'000'000 + *second_ns;
}

void refuse(const fs::path& file,
            std::int64_t line,
            const std::string& field,
            const std::string& got,
            const std::string& want) {
  throw BadInput({Severity::kError, file.string(), line, field, got, want});
}

TextTable read_text_table(const fs::path& file, char separator, std::size_t columns) {
  LineReader reader(file);
  if (!reader.is_open()) refuse(file, 0, "", "no readable file", "a table");
  TextTable table;
  while (const auto text = reader.next()) {
    const std::string_view row = trim(*text);
    if (row.empty() || row.front() == '#') continue;
    if (const auto fault = encoding_fault(row); !fault.empty())
      refuse(file, reader.line(), "", fault, "UTF-8 text");
    const auto fields_here = separator == ' ' ? split_at_blanks(row) : split(row, separator);
    std::vector<std::string> fields(fields_here.begin(), fields_here.end());
    const char first = row.front();
    if (table.rows.empty() && table.header.empty() && columns != 0 &&
        ((first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z'))) {
      table.header = std::move(fields);
      continue;
    }
    if (columns != 0 && fields.size() != columns)
      refuse(file, reader.line(), "row",
             std::to_string(fields.size()) + " fields" +
                 in_brackets(layout_fault(row, separator, fields.size(), columns)),
             std::to_string(columns) + " with " + separator_name(separator) + " between them");
    table.rows.push_back(std::move(fields));
    table.lines.push_back(reader.line());
  }
  if (reader.too_long()) refuse(file, reader.line(), "", "a line longer than 64 KiB", "a table");
  if (table.rows.empty()) refuse(file, 0, "", "no rows", "at least one");
  return table;
}

std::vector<double> row_numbers(const fs::path& file,
                                const TextTable& table,
                                std::size_t row,
                                std::size_t first) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < table.rows[row].size(); ++i) {
    const auto value = parse_double(table.rows[row][i]);
    if (!value)
      refuse(file, table.lines[row], "column " + std::to_string(i + 1),
             printable(table.rows[row][i]), number_wanted(table.rows[row][i]));
    numbers.push_back(*value);
  }
  return numbers;
}

std::vector<double> line_numbers(const fs::path& file, std::int64_t line, std::string_view text) {
  const auto fields = split_at_blanks(text);
  TextTable table;
  table.rows.emplace_back(fields.begin(), fields.end());
  table.lines.push_back(line);
  return row_numbers(file, table, 0);
}

Eigen::Isometry3d pose_of_rows(const fs::path& file,
                               std::int64_t line,
                               std::span<const double> numbers) {
  if (numbers.size() != 12)
    refuse(file, line, "pose", std::to_string(numbers.size()) + " numbers", "12");
  const Eigen::Matrix<double, 3, 4> m =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
  const Eigen::Matrix3d R = m.leftCols<3>();
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= 1e-3) || !(R.determinant() > 0.0))
    refuse(file, line, "pose", "no rotation", "orthonormal, right-handed axes");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = nearest_rotation(R);
  T.translation() = m.col(3);
  return T;
}

std::optional<fs::path> first_existing(std::initializer_list<fs::path> paths) {
  for (const auto& path : paths) {
    std::error_code error;
    if (fs::exists(path, error)) return path;
  }
  return std::nullopt;
}

Eigen::Matrix3d forward_camera_axes() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R;
}

void LeftOut::leave(std::int64_t line) {
  if (left_++ > 0) return;
  first_line_ = line;
  first_row_ = taken_ + 1;
}

void LeftOut::report(const ImportOptions& options, ImportResult& result) const {
  if (left_ == 0) return;
  const std::size_t all = taken_ + left_;
  const double share = static_cast<double>(left_) / static_cast<double>(all);
  std::string got = std::to_string(left_) + " of " + std::to_string(all) + " " + what_ + " (" +
                    percent(share) + ") that " + why_;
  if (first_line_ == 0 && what_ == "rows")
    got += ", the first of them number " + std::to_string(first_row_);
  if (left_ > 1 && share > options.max_left_out)
    refuse(file_, first_line_, what_, got,
           want_ + ", or at most " + percent(options.max_left_out) +
               " that are left out (--max-left-out)");
  result.warnings.push_back(
      {Severity::kWarning, file_.string(), first_line_, what_, got + "; left out", want_});
}

Ascending::Ascending(const fs::path& file)
    : rows_(file,
            "rows",
            "repeat a stamp or go back in time",
            "ascending stamps (where the clock was set back, import the parts one by one)") {}

bool Ascending::accept(std::int64_t t_ns, std::int64_t line) {
  if (t_ns <= last_) {
    rows_.leave(line);
    return false;
  }
  last_ = t_ns;
  rows_.take();
  return true;
}

std::size_t FrameLines::filled() const {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](const auto& line) { return !line.empty(); }));
}

FrameLines read_frame_lines(const fs::path& file) {
  LineReader reader(file);
  if (!reader.is_open()) refuse(file, 0, "", "no readable file", "a line for each frame");
  FrameLines frames;
  while (const auto line = reader.next()) {
    if (const auto fault = encoding_fault(*line); !fault.empty())
      refuse(file, reader.line(), "", fault, "UTF-8 text");
    const std::string_view text = trim(*line);
    if (text.starts_with('#')) continue;
    frames.text.emplace_back(text);
    frames.lines.push_back(reader.line());
  }
  if (reader.too_long()) refuse(file, reader.line(), "", "a line longer than 64 KiB", "a table");
  while (!frames.text.empty() && frames.text.back().empty()) {
    frames.text.pop_back();
    frames.lines.pop_back();
  }
  if (frames.text.empty()) refuse(file, 0, "", "no rows", "a line for each frame");
  return frames;
}

std::vector<std::optional<std::int64_t>> frame_stamps(
    const fs::path& file,
    const FrameLines& frames,
    std::optional<std::int64_t> (*parse)(std::string_view),
    const std::string& want) {
  std::vector<std::optional<std::int64_t>> stamps;
  std::int64_t last = -1;
  for (std::size_t i = 0; i < frames.text.size(); ++i) {
    stamps.emplace_back();
    if (frames.text[i].empty()) continue;
    stamps.back() = parse(frames.text[i]);
    if (!stamps.back() || *stamps.back() <= last)
      refuse(file, frames.lines[i], "time", printable(frames.text[i]), "ascending " + want);
    last = *stamps.back();
  }
  return stamps;
}

}  // namespace roadbook
