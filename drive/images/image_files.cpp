#include "drive/images/image_files.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "base/text.hpp"
#include "drive/csv.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

char small_letter(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::size_t end_of_digits(std::string_view text, std::size_t begin) {
  while (begin < text.size() && is_digit(text[begin])) ++begin;
  return begin;
}

// Numbers of any length: the one with more digits is larger.
int compare_numbers(std::string_view a, std::string_view b) {
  a.remove_prefix(std::min(a.find_first_not_of('0'), a.size()));
  b.remove_prefix(std::min(b.find_first_not_of('0'), b.size()));
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

int compare_decimals(std::string_view a, std::string_view b) {
  a = a.substr(0, a.find_last_not_of('0') + 1);
  b = b.substr(0, b.find_last_not_of('0') + 1);
  return a.compare(b);
}

// Below 0: `a` comes first; 0: nothing but zeros and capitals tell them apart.
int compare_names(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const bool decimals = i >= 2 && a[i - 1] == '.' && is_digit(a[i - 2]) && j >= 2 &&
                            b[j - 1] == '.' && is_digit(b[j - 2]);
      const std::size_t i_end = end_of_digits(a, i);
      const std::size_t j_end = end_of_digits(b, j);
      const std::string_view x = a.substr(i, i_end - i);
      const std::string_view y = b.substr(j, j_end - j);
      if (const int order = decimals ? compare_decimals(x, y) : compare_numbers(x, y)) return order;
      i = i_end;
      j = j_end;
    } else {
      const auto x = static_cast<unsigned char>(small_letter(a[i++]));
      const auto y = static_cast<unsigned char>(small_letter(b[j++]));
      if (x != y) return x < y ? -1 : 1;
    }
  }
  return static_cast<int>(i < a.size()) - static_cast<int>(j < b.size());
}

const std::array<std::string, 3>& image_extensions() {
  static const std::array<std::string, 3> extensions = {".png", ".jpg", ".jpeg"};
  return extensions;
}

bool has_extension(const fs::path& file, std::span<const std::string> extensions) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), small_letter);
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

[[noreturn]] void refuse_names(const fs::path& folder,
                               const fs::path& a,
                               const fs::path& b,
                               const std::string& want) {
  throw BadInput({Severity::kError, folder.string(), 0, "images",
                  printable(a.filename().string()) + " and " + printable(b.filename().string()),
                  want});
}

}  // namespace

bool precedes_by_number(std::string_view a, std::string_view b) { return compare_names(a, b) < 0; }

std::string name_pattern(std::string_view name) {
  std::string pattern;
  for (std::size_t i = 0; i < name.size();) {
    pattern += is_digit(name[i]) ? '#' : small_letter(name[i]);
    i = is_digit(name[i]) ? end_of_digits(name, i) : i + 1;
  }
  return pattern;
}

std::optional<std::int64_t> frame_number(const fs::path& file) {
  const std::string name = file.stem().string();
  std::size_t end = name.size();
  while (end > 0 && !is_digit(name[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && is_digit(name[begin - 1])) --begin;
  if (begin == end) return std::nullopt;
  return parse_int(std::string_view(name).substr(begin, end - begin));
}

std::vector<fs::path> files_in(const fs::path& folder, std::span<const std::string> extensions) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (has_extension(it->path(), extensions)) files.push_back(it->path());
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    const int order = compare_names(a.stem().string(), b.stem().string());
    return order != 0 ? order < 0 : a < b;
  });
  return files;
}

std::vector<fs::path> image_files(const fs::path& folder) {
  auto files = files_in(folder, image_extensions());
  for (std::size_t i = 1; i < files.size(); ++i) {
    const std::string before = files[i - 1].stem().string();
    const std::string now = files[i].stem().string();
    if (name_pattern(before) != name_pattern(now))
      refuse_names(folder, files[i - 1], files[i], "names that differ only in their numbers");
    if (compare_names(before, now) == 0)
      refuse_names(folder, files[i - 1], files[i], "one image for each number");
  }
  return files;
}

std::size_t count_images(const fs::path& folder) {
  std::size_t count = 0;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    count += has_extension(it->path(), image_extensions()) ? 1 : 0;
  return count;
}

}  // namespace roadbook
