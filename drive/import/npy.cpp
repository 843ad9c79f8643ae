#include "drive/import/npy.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "base/text.hpp"
#include "base/text_file.hpp"
#include "drive/import/import_support.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// The text behind 'KEY': in the header, a Python dictionary.
std::string_view entry(const fs::path& file, std::string_view header, std::string_view key) {
  const auto at = header.find("'" + std::string(key) + "':");
  if (at == std::string_view::npos) refuse(file, 0, std::string(key), "nothing", "a .npy header");
  return trim(header.substr(at + key.size() + 3));
}

std::vector<std::size_t> parse_shape(const fs::path& file, std::string_view text) {
  constexpr std::int64_t kMaxElements = 1 << 27;
  const auto close = text.find(')');
  if (text.empty() || text.front() != '(' || close == std::string_view::npos)
    refuse(file, 0, "shape", "no tuple", "(rows, ...)");
  std::vector<std::size_t> shape;
  std::int64_t elements = 1;
  for (const auto part : split(text.substr(1, close - 1))) {
    if (part.empty()) continue;
    const auto n = parse_int(part);
    if (!n || *n < 0 || *n > kMaxElements)
      refuse(file, 0, "shape", std::string(part.substr(0, 20)), "sizes");
    shape.push_back(static_cast<std::size_t>(*n));
    if ((elements *= *n) > kMaxElements)
      refuse(file, 0, "shape", "too many numbers", "at most 2^27");
  }
  return shape;
}

template <typename Number>
void convert(std::string_view bytes, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    Number number{};
    std::memcpy(&number, bytes.data() + i * sizeof(Number), sizeof(Number));
    values[i] = static_cast<double>(number);
  }
}

}  // namespace

NpyArray read_npy(const fs::path& file) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  const std::string content = read_regular_file(file, "a .npy file up to 1 GiB");
  const std::size_t size = content.size();
  if (size < 12 || !content.starts_with(kMagic))
    refuse(file, 0, "", "another kind of file", "a .npy file");
  const auto byte = [&](std::size_t i) {
    return std::size_t{static_cast<unsigned char>(content[i])};
  };
  const bool wide = byte(6) >= 2;
  const std::size_t begin = wide ? 12 : 10;
  std::size_t length = byte(8) | byte(9) << 8;
  if (wide) length |= byte(10) << 16 | byte(11) << 24;
  if (begin + length > size) refuse(file, 0, "header", "a file cut short", "a .npy header");
  const std::string_view header(content.data() + begin, length);
  if (!entry(file, header, "fortran_order").starts_with("False"))
    refuse(file, 0, "fortran_order", "True", "False");
  NpyArray array;
  array.shape = parse_shape(file, entry(file, header, "shape"));
  std::size_t count = 1;
  for (const std::size_t n : array.shape)
    if (__builtin_mul_overflow(count, n, &count) || count > size)
      refuse(file, 0, "shape", "more numbers than the file has bytes", "the numbers of the file");
  const std::string_view type = entry(file, header, "descr").substr(0, 5);
  const std::size_t width = type.size() == 5 && type[3] == '4' ? 4 : 8;
  const std::string_view bytes(content.data() + begin + length, size - begin - length);
  if (bytes.size() < count * width)
    refuse(file, 0, "", "a file cut short", std::to_string(count) + " numbers");
  array.values.resize(count);
  if (type == "'<f8'")
    convert<double>(bytes, array.values);
  else if (type == "'<f4'")
    convert<float>(bytes, array.values);
  else if (type == "'<i8'")
    convert<std::int64_t>(bytes, array.values);
  else if (type == "'<i4'")
    convert<std::int32_t>(bytes, array.values);
  else
    refuse(file, 0, "descr", std::string(type), "'<f8', '<f4', '<i8' or '<i4'");
  for (const double value : array.values)
    if (!std::isfinite(value))
      refuse(file, 0, "values", "a number that is not finite", "finite numbers");
  return array;
}

}  // namespace roadbook
