#include "tests/diagnosis/hidden_views/gone_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "diagnosis/map_changes/removed_landmarks.hpp"

// Tests of redetection rates in worlds with other rules: visibility depends on distance and angle,
// objects are hidden temporarily, and some objects are recognised badly.

namespace roadbook::test {
namespace {

TEST(GoneWorld, NothingIsNamedWhereEverythingStands) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    GoneWorldOptions options;
    options.seed = seed;
    const GoneWorld world = make_gone_world(options);
    const RemovedLandmarks g = removed_landmarks(landmark_redetections(world.map, 1, {}));
    EXPECT_TRUE(g.places.empty()) << "seed " << seed;
    EXPECT_GT(g.tests, 50U) << "seed " << seed;
  }
}

// Most objects with 50 landmarks are found, whether 5 % or 20 % of all are removed.
TEST(GoneWorld, ThingsThatAreGoneAreNamedHoweverManyThereAre) {
  for (const double share : {0.05, 0.2}) {
    int gone = 0;
    int named = 0;
    for (std::uint64_t seed = 101; seed <= 106; ++seed) {
      GoneWorldOptions options;
      options.seed = seed;
      options.per_square = 80.0;
      options.share_gone = share;
      const GoneWorld world = make_gone_world(options);
      const std::vector<LandmarkRedetection> chances = landmark_redetections(world.map, 1, {});
      std::vector<int> there(world.gone.size(), 0);
      std::vector<int> judged(world.gone.size(), 0);
      const auto thing = [&](std::size_t i) {
        return world.thing_of[static_cast<std::size_t>(chances[i].landmark)];
      };
      for (std::size_t i = 0; i < chances.size(); ++i)
        if (thing(i) >= 0) ++there[static_cast<std::size_t>(thing(i))];
      for (const std::size_t i : removed_landmarks(chances).judged)
        if (thing(i) >= 0) ++judged[static_cast<std::size_t>(thing(i))];
      for (std::size_t t = 0; t < there.size(); ++t) {
        if (!world.gone[t] || there[t] < 50) continue;
        ++gone;
        named += 3 * judged[t] >= there[t] ? 1 : 0;
      }
    }
    EXPECT_GT(gone, 3) << share;
    EXPECT_GE(3 * named, 2 * gone) << named << " of " << gone << " at " << share;
  }
}

}  // namespace
}  // namespace roadbook::test
