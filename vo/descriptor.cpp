#include "vo/descriptor.hpp"

#include <bit>
#include <cstring>

namespace roadbook {
namespace {

[[gnu::always_inline]] inline int distance_of(const std::uint8_t* a, const std::uint8_t* b) {
  int distance = 0;
  for (std::size_t i = 0; i < 64; i += 8) {
    std::uint64_t x = 0;
    std::uint64_t y = 0;
    std::memcpy(&x, a + i, 8);
    std::memcpy(&y, b + i, 8);
    distance += std::popcount(x ^ y);
  }
  return distance;
}

}  // namespace

// Baseline x86-64 has no popcnt instruction: the generic count goes through a table.
__attribute__((target_clones("popcnt", "default"))) int hamming(const Descriptor& a,
                                                                const Descriptor& b) {
  return distance_of(a.data(), b.data());
}

__attribute__((target_clones("popcnt", "default"))) NearestDescriptor nearest_descriptor(
    const Descriptor& query, std::span<const Descriptor> descriptors) {
  NearestDescriptor best;
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    const int distance = distance_of(query.data(), descriptors[i].data());
    if (distance < best.distance) {
      best.second = best.distance;
      best.distance = distance;
      best.index = static_cast<int>(i);
    } else if (distance < best.second) {
      best.second = distance;
    }
  }
  return best;
}

}  // namespace roadbook
