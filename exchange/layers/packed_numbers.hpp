#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "mapping/layers/layer_types.hpp"

namespace roadbook {

/// Bytes in zlib's format (RFC 1950), which the standard library of Python reads. The same bytes
/// for the same input.
[[nodiscard]] Bytes packed_bytes(std::span<const std::uint8_t> bytes);
/// Empty if the bytes are damaged or do not hold `size` bytes.
[[nodiscard]] std::optional<Bytes> unpacked_bytes(const Bytes& packed, std::size_t size);

/// Numbers of 16 bits, packed: all low bytes, then all high bytes.
template <typename Number>
[[nodiscard]] Bytes packed_numbers(const std::vector<Number>& numbers) {
  static_assert(sizeof(Number) == 2);
  Bytes bytes(2 * numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto bits = static_cast<std::uint16_t>(numbers[i]);
    bytes[i] = static_cast<std::uint8_t>(bits & 0xFFU);
    bytes[numbers.size() + i] = static_cast<std::uint8_t>(bits >> 8U);
  }
  return packed_bytes(bytes);
}

/// Empty if the bytes are damaged or do not hold `count` numbers.
template <typename Number>
[[nodiscard]] std::optional<std::vector<Number>> unpacked_numbers(const Bytes& packed,
                                                                  std::size_t count) {
  static_assert(sizeof(Number) == 2);
  const auto bytes = unpacked_bytes(packed, 2 * count);
  if (!bytes) return std::nullopt;
  std::vector<Number> numbers(count);
  for (std::size_t i = 0; i < count; ++i)
    numbers[i] =
        static_cast<Number>(static_cast<std::uint16_t>((*bytes)[i] | ((*bytes)[count + i] << 8U)));
  return numbers;
}

}  // namespace roadbook
