#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace roadbook {

/// 512-bit BRISK descriptor.
using Descriptor = std::array<std::uint8_t, 64>;

/// Number of differing bits, 0..512.
[[nodiscard]] inline int hamming(const Descriptor& a, const Descriptor& b) {
  std::array<std::uint64_t, 8> x{};
  std::array<std::uint64_t, 8> y{};
  std::memcpy(x.data(), a.data(), sizeof x);
  std::memcpy(y.data(), b.data(), sizeof y);
  int distance = 0;
  for (std::size_t i = 0; i < x.size(); ++i) distance += std::popcount(x[i] ^ y[i]);
  return distance;
}

}  // namespace roadbook
