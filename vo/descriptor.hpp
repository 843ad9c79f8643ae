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

/// The nearest of many descriptors, and the distance of the second nearest.
struct NearestDescriptor {
  int index = -1;                                  ///< of the nearest; -1: there are none
  int distance = std::numeric_limits<int>::max();  ///< of the nearest [differing bits]
  int second = std::numeric_limits<int>::max();    ///< of the second nearest [differing bits]
};
[[nodiscard]] NearestDescriptor nearest_descriptor(const Descriptor& query,
                                                   std::span<const Descriptor> descriptors);

}  // namespace roadbook
