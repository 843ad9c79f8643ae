#include "base/utf8.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace roadbook {
namespace {

// Bytes of the character that begins so; 0: none does.
std::size_t bytes_of(unsigned char first) {
  if (first < 0x80U) return 1;
  if (first < 0xC0U) return 0;
  if (first < 0xE0U) return 2;
  if (first < 0xF0U) return 3;
  return first < 0xF8U ? 4 : 0;
}

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

}  // namespace

std::optional<std::size_t> utf8_characters(std::string_view text) {
  constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  std::size_t characters = 0;
  for (std::size_t i = 0, bytes = 0; i < text.size(); i += bytes, ++characters) {
    bytes = bytes_of(static_cast<unsigned char>(text[i]));
    if (bytes == 0) return std::nullopt;
    const std::string_view rest = text.substr(i + 1, bytes - 1);
    if (!std::all_of(rest.begin(), rest.end(), continues)) return std::nullopt;
    std::uint32_t code =
        static_cast<unsigned char>(text[i]) & (bytes == 1 ? 0x7FU : 0x7FU >> bytes);
    for (const char c : rest) code = code << 6U | (static_cast<unsigned char>(c) & 0x3FU);
    // One that the text cuts short has a code too small for its length.
    if (code < kLeast[bytes] || code > 0x10FFFFU || (code >= 0xD800U && code <= 0xDFFFU))
      return std::nullopt;
  }
  return characters;
}

}  // namespace roadbook
