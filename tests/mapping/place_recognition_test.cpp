#include "mapping/loops/place_recognition.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr int kAgain = 20;  // the keyframe that sees what keyframe 5 saw

// Twenty keyframes along a row of things: each sees 24 of them, three of them new. The last one is
// at the place of keyframe 5 again.
std::vector<VoKeyframe> along_a_row() {
  Random random(1, "row of things");
  std::vector<Descriptor> things(3 * kAgain + 24);
  for (Descriptor& thing : things)
    for (std::uint8_t& byte : thing) byte = static_cast<std::uint8_t>(random.below(256));
  std::vector<VoKeyframe> keyframes;
  for (int k = 0; k <= kAgain; ++k) {
    const std::size_t first = 3 * static_cast<std::size_t>(k == kAgain ? 5 : k);
    Features features;
    for (std::size_t i = 0; i < 24; ++i)
      for (int corner = 0; corner < 8; ++corner) {  // the vocabulary learns every 8th
        features.pixels.emplace_back(0.0F, 0.0F);
        features.descriptors.push_back(things[first + i]);
      }
    keyframes.emplace_back().features.push_back(features);
  }
  return keyframes;
}

TEST(PlaceIndex, ReturnsTheMostSimilarKeyframesBestFirstAndNoMoreThanWanted) {
  const PlaceIndex index(along_a_row(), 1);
  const auto all = [](int) { return true; };
  for (const std::size_t count : {1U, 3U, 6U}) {
    const auto found = index.similar(kAgain, all, count, 0);
    ASSERT_EQ(found.size(), count);
    EXPECT_EQ(found[0].keyframe, 5);
    EXPECT_NEAR(found[0].score, 1.0, 1e-5);  // weights are floats
    for (std::size_t i = 1; i < count; ++i) {
      EXPECT_LE(found[i].score, found[i - 1].score);
      EXPECT_LE(std::abs(found[i].keyframe - 5), 7);  // sees something that keyframe 5 sees
    }
  }
}

TEST(PlaceIndex, OfNeighboursOnlyTheBestIsReturned) {
  const PlaceIndex index(along_a_row(), 2);
  const auto found = index.similar(
      kAgain, [](int) { return true; }, 3, 2);
  ASSERT_GE(found.size(), 2U);
  EXPECT_EQ(found[0].keyframe, 5);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(std::abs(found[i].keyframe - found[j].keyframe), 2);
  for (const PlaceCandidate& other : index.similar(
           kAgain, [](int k) { return k < 4; }, 9, 0))
    EXPECT_LT(other.keyframe, 4);
}

}  // namespace
}  // namespace roadbook
