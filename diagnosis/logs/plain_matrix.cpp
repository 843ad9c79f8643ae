#include "diagnosis/logs/plain_matrix.hpp"

#include <libdeflate.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

#include "base/text_file.hpp"

namespace roadbook {
namespace {

using MatBytes = std::vector<unsigned char>;

// MAT-file format, version 5: types of data elements (table 1-1).
constexpr std::uint32_t kDouble = 9, kMatrix = 14, kCompressed = 15;
constexpr std::size_t kHeader = 128;
constexpr std::size_t kMostBytes = 1U << 28;

struct Element {
  std::uint32_t type = 0;
  std::span<const unsigned char> data;
};

std::uint32_t word(std::span<const unsigned char> bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

// The element at the front of `rest`, which moves behind it; nothing where it is cut off.
std::optional<Element> next_element(std::span<const unsigned char>& rest, bool padded) {
  if (rest.size() < 8) return std::nullopt;
  const std::uint32_t first = word(rest);
  if (first >> 16 != 0) {  // small form: size and type in one word, data in the next
    const std::size_t size = first >> 16;
    if (size > 4) return std::nullopt;
    const Element e{first & 0xffffU, rest.subspan(4, size)};
    rest = rest.subspan(8);
    return e;
  }
  const std::size_t size = word(rest.subspan(4));
  if (size > rest.size() - 8) return std::nullopt;
  const Element e{first, rest.subspan(8, size)};
  const std::size_t whole = padded ? (size + 7) / 8 * 8 : size;
  rest = rest.subspan(std::min(rest.size(), 8 + whole));
  return e;
}

std::optional<MatBytes> inflated(std::span<const unsigned char> data) {
  libdeflate_decompressor* const tool = libdeflate_alloc_decompressor();
  MatBytes out;
  std::optional<MatBytes> result;
  for (std::size_t size = std::max<std::size_t>(4096, 8 * data.size()); size <= kMostBytes;
       size *= 2) {
    out.resize(size);
    std::size_t written = 0;
    const auto status = libdeflate_zlib_decompress(tool, data.data(), data.size(), out.data(),
                                                   out.size(), &written);
    if (status == LIBDEFLATE_INSUFFICIENT_SPACE) continue;
    if (status == LIBDEFLATE_SUCCESS) {
      out.resize(written);
      result = std::move(out);
    }
    break;
  }
  libdeflate_free_decompressor(tool);
  return result;
}

// Fills `table` if the matrix element has the name and holds plain doubles.
bool take_matrix(std::span<const unsigned char> data, const std::string& name, LogTable& table) {
  (void)next_element(data, true);  // flags
  const auto dimensions = next_element(data, true);
  const auto title = next_element(data, true);
  const auto values = next_element(data, true);
  if (!dimensions || !title || !values || dimensions->data.size() != 8) return false;
  if (std::string(title->data.begin(), title->data.end()) != name) return false;
  const std::size_t rows = word(dimensions->data);
  const std::size_t columns = word(dimensions->data.subspan(4));
  if (values->type != kDouble || columns == 0 || values->data.size() / 8 / columns != rows)
    return false;
  for (std::size_t r = 0; r < rows; ++r) {
    std::vector<std::string> row;
    for (std::size_t c = 0; c < columns; ++c) {
      double value = 0.0;
      std::memcpy(&value, values->data.data() + 8 * (r + rows * c), sizeof value);
      char text[40];
      std::snprintf(text, sizeof text, "%.17g", value);
      row.emplace_back(text);
    }
    table.rows.push_back(std::move(row));
    table.lines.push_back(static_cast<std::int64_t>(r) + 1);
  }
  return true;
}

}  // namespace

LogTable read_matrix_table(const std::filesystem::path& file,
                           const std::string& matrix,
                           ProblemList& problems) {
  LogTable table;
  table.file = file.string();
  require_regular_file(file, "a MATLAB 5.0 file");
  std::ifstream stream(file, std::ios::binary);
  const MatBytes bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (bytes.size() < kHeader + 8 || std::memcmp(bytes.data(), "MATLAB 5.0", 10) != 0) {
    problems.error(table.file, 0, "", "a file that is not MATLAB 5.0 or cannot be read",
                   "a MATLAB 5.0 file");
    return table;
  }
  std::span<const unsigned char> rest(bytes);
  rest = rest.subspan(kHeader);
  while (const auto element = next_element(rest, false)) {
    if (element->type == kMatrix && take_matrix(element->data, matrix, table)) return table;
    if (element->type != kCompressed) continue;
    const auto plain = inflated(element->data);
    if (!plain) continue;
    std::span<const unsigned char> inside(*plain);
    const auto inner = next_element(inside, true);
    if (inner && inner->type == kMatrix && take_matrix(inner->data, matrix, table)) return table;
  }
  problems.error(table.file, 0, "matrix", matrix, "the name of a real matrix of this file");
  return table;
}

}  // namespace roadbook
