#include "vo/descriptor.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "base/random.hpp"

namespace roadbook {
namespace {

Descriptor random_descriptor(Random& random) {
  Descriptor d;
  for (auto& byte : d) byte = static_cast<std::uint8_t>(random());
  return d;
}

int slow_hamming(const Descriptor& a, const Descriptor& b) {
  int distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    distance += std::popcount(static_cast<unsigned>(a[i] ^ b[i]));
  return distance;
}

TEST(Descriptor, HammingCountsDifferingBits) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const auto a = random_descriptor(random);
    const auto b = random_descriptor(random);
    EXPECT_EQ(hamming(a, b), slow_hamming(a, b));
    EXPECT_EQ(hamming(a, a), 0);
  }
}

TEST(Descriptor, NearestKnowsTheRunnerUp) {
  Random random(2);
  std::vector<Descriptor> all;
  for (int i = 0; i < 50; ++i) all.push_back(random_descriptor(random));
  Descriptor query = all[17];
  query[3] ^= 0x0F;
  const auto near = nearest_descriptor(query, all);
  EXPECT_EQ(near.index, 17);
  EXPECT_EQ(near.distance, 4);
  int second = 1000;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i != 17) second = std::min(second, slow_hamming(query, all[i]));
  EXPECT_EQ(near.second, second);
  EXPECT_EQ(nearest_descriptor(query, {}).index, -1);
}

// Sets of every small size, in which some differ from the query in few bits and some are equal to
// each other: the first of equal ones is the nearest, and another one the second.
TEST(Descriptor, TheNearestOfAnyNumberIsThatOfPlainCounting) {
  Random random(3);
  for (int round = 0; round < 400; ++round) {
    const auto size = static_cast<std::size_t>(round % 23);
    const Descriptor query = random_descriptor(random);
    std::vector<Descriptor> all;
    for (std::size_t i = 0; i < size; ++i) {
      all.push_back(random.uniform() < 0.5 ? query : random_descriptor(random));
      if (random.uniform() < 0.3) all.back() = all[random.below(all.size())];
      const std::uint64_t changed = random.below(4);
      for (std::uint64_t k = 0; k < changed; ++k) all.back()[random.below(64)] ^= 0x11;
    }
    NearestDescriptor want;
    for (std::size_t i = 0; i < size; ++i) {
      const int distance = slow_hamming(query, all[i]);
      if (distance < want.distance) {
        want = {static_cast<int>(i), distance, want.distance};
      } else if (distance < want.second) {
        want.second = distance;
      }
    }
    const auto near = nearest_descriptor(query, all);
    EXPECT_EQ(near.index, want.index) << size;
    EXPECT_EQ(near.distance, want.distance) << size;
    EXPECT_EQ(near.second, want.second) << size;
  }
}

}  // namespace
}  // namespace roadbook
