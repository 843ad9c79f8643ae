#include "mapping/landmark_weights.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

// The test draws when each landmark disappears. Until then each session sees it with the landmark's
// own probability; afterwards no session sees it.

namespace roadbook {
namespace {

constexpr int kSessions = 6;

struct DrawnLandmarks {
  Map map;
  std::vector<int> went;  // session from which on it is gone; kSessions: never
};

DrawnLandmarks drawn_landmarks(std::uint64_t seed, double share_gone) {
  Random random(seed, "landmark weights");
  DrawnLandmarks drawn;
  for (int l = 0; l < 3000; ++l) {
    drawn.map.landmarks.emplace_back();
    const bool goes = random.uniform() < share_gone;
    drawn.went.push_back(goes ? 1 + static_cast<int>(random.below(kSessions - 1)) : kSessions);
    const double chance = random.uniform(0.85, 1.0);
    for (int s = 1; s < kSessions; ++s) {
      const bool seen = s < drawn.went.back() && random.uniform() < chance;
      drawn.map.landmark_sessions.push_back({l, s, 20 + static_cast<int>(random.below(20)),
                                             seen ? 4 : 0, seen ? std::optional(s) : std::nullopt});
    }
  }
  return drawn;
}

TEST(LandmarkWeights, TellWhatIsGoneFromWhatIsThere) {
  const DrawnLandmarks drawn = drawn_landmarks(11, 0.3);
  const std::vector<double> weights = landmark_weights(drawn.map);
  int there = 0;
  int there_kept = 0;
  int gone = 0;
  int gone_left = 0;
  for (std::size_t l = 0; l < weights.size(); ++l) {
    if (drawn.went[l] == kSessions) {
      ++there;
      there_kept += weights[l] >= 0.5 ? 1 : 0;
    } else if (drawn.went[l] <= kSessions - 3) {  // three sessions or more passed without it
      ++gone;
      gone_left += weights[l] < kLeastWeight ? 1 : 0;
    }
  }
  EXPECT_GE(there_kept, 0.99 * there);
  // A landmark that a session missed while it was there may be one that is seldom seen.
  EXPECT_GE(gone_left, 0.96 * gone);
}

// A parked car hides a landmark for one session; after it has left, the landmark counts again.
TEST(LandmarkWeights, ComeBackWithTheLandmark) {
  Map map = drawn_landmarks(12, 0.1).map;
  const auto weight_after = [&](const std::vector<bool>& seen) {
    Map with = map;
    const int l = static_cast<int>(with.landmarks.size());
    with.landmarks.emplace_back();
    for (std::size_t s = 0; s < seen.size(); ++s)
      with.landmark_sessions.push_back({l, static_cast<int>(s) + 1, 25, seen[s] ? 3 : 0, {}});
    return landmark_weights(with).back();
  };
  EXPECT_GE(weight_after({true, true, true, false}), 0.5) << "hidden once";
  EXPECT_LT(weight_after({true, false, false, false}), kLeastWeight) << "gone";
  EXPECT_GE(weight_after({true, false, false, false, true}), 0.5) << "seen again";
  EXPECT_GT(weight_after({false}), weight_after({false, false}));
}

// Few images tell less than many, and none tell nothing.
TEST(LandmarkWeights, AskForTheChanceToSeeIt) {
  Map map = drawn_landmarks(13, 0.2).map;
  const auto weight_after = [&](int images) {
    Map with = map;
    const int l = static_cast<int>(with.landmarks.size());
    with.landmarks.emplace_back();
    for (int s = 1; s < 4; ++s) with.landmark_sessions.push_back({l, s, images, 0, {}});
    return landmark_weights(with).back();
  };
  EXPECT_LT(weight_after(30), kLeastWeight);
  EXPECT_GT(weight_after(1), 2.0 * weight_after(30));
  EXPECT_EQ(weight_after(0), 1.0);
  EXPECT_TRUE(landmark_weights(Map()).empty());
}

}  // namespace
}  // namespace roadbook
