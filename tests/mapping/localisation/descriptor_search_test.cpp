#include "mapping/localisation/descriptor_search.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/localisation/synthetic_place.hpp"

namespace roadbook {
namespace {

struct Known {
  std::vector<Descriptor> all;
  std::vector<Descriptor> queries;  // of the first ones, with flipped bits
};

Known known(int count, int queries, int bits) {
  Random random(1, "descriptor search");
  Known k;
  for (int i = 0; i < count; ++i) k.all.push_back(test::random_descriptor(random));
  for (int i = 0; i < queries; ++i)
    k.queries.push_back(test::with_flipped_bits(k.all[at(i)], bits, random));
  return k;
}

DescriptorSearchOptions by(DescriptorSearchMethod method) {
  DescriptorSearchOptions options;
  options.method = method;
  return options;
}

TEST(DescriptorSearch, ExactFindsTheNearestInOrder) {
  const Known k = known(500, 20, 30);
  const DescriptorSearch search(k.all, by(DescriptorSearchMethod::kExact));
  const auto found = search.nearest(k.queries, 3, 512);
  for (std::size_t q = 0; q < found.size(); ++q) {
    ASSERT_EQ(found[q].size(), 3U);
    EXPECT_EQ(found[q][0].index, static_cast<int>(q));
    EXPECT_EQ(found[q][0].distance, hamming(k.queries[q], k.all[q]));
    EXPECT_LE(found[q][0].distance, found[q][1].distance);
    EXPECT_LE(found[q][1].distance, found[q][2].distance);
  }
  EXPECT_TRUE(search.nearest(k.queries, 3, 5)[0].empty());
}

// Neighbours as far as those of revisits are (half of the matches differ in less than 55 bits).
TEST(DescriptorSearch, LshFindsWhatTheExactSearchFinds) {
  const Known k = known(20000, 400, 50);
  const DescriptorSearch exact(k.all, by(DescriptorSearchMethod::kExact));
  const DescriptorSearch lsh(k.all, by(DescriptorSearchMethod::kLsh));
  const auto want = exact.nearest(k.queries, 1, 95);
  const auto got = lsh.nearest(k.queries, 1, 95);
  int same = 0;
  int all = 0;
  for (std::size_t q = 0; q < want.size(); ++q) {
    if (want[q].empty()) continue;
    ++all;
    same += !got[q].empty() && got[q][0].index == want[q][0].index ? 1 : 0;
  }
  EXPECT_GT(all, 390);
  EXPECT_GE(same, 0.9 * all);
}

TEST(DescriptorSearch, SameSeedGivesTheSameAnswers) {
  const Known k = known(5000, 300, 60);
  const auto answers = [&](std::uint64_t seed) {
    DescriptorSearchOptions options = by(DescriptorSearchMethod::kLsh);
    options.seed = seed;
    std::vector<int> flat;
    for (const auto& list : DescriptorSearch(k.all, options).nearest(k.queries, 2, 120))
      for (const NearDescriptor& one : list) flat.push_back(one.index);
    return flat;
  };
  EXPECT_EQ(answers(1), answers(1));
  EXPECT_NE(answers(1), answers(2));
}

TEST(DescriptorSearch, NothingIsFoundInNothing) {
  const DescriptorSearch search({}, by(DescriptorSearchMethod::kLsh));
  EXPECT_TRUE(search.nearest({Descriptor{}}, 3, 512)[0].empty());
}

}  // namespace
}  // namespace roadbook
