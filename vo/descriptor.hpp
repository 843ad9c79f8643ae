#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

namespace roadbook {

/// 512-bit BRISK descriptor.
using Descriptor = std::array<std::uint8_t, 64>;

/// Number of differing bits, 0..512.
[[nodiscard]] int hamming(const Descriptor& a, const Descriptor& b);

/// The nearest of many descriptors and how near the runner-up comes.
struct NearestDescriptor {
  int index = -1;
  int distance = std::numeric_limits<int>::max();
  int second = std::numeric_limits<int>::max();
};
[[nodiscard]] NearestDescriptor nearest_descriptor(const Descriptor& query,
                                                   std::span<const Descriptor> descriptors);

}  // namespace roadbook
