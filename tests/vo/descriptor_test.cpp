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

}  // namespace
}  // namespace roadbook
