#include "chicago.hpp"

#include <gtest/gtest.h>

#include "tests/support/real_data.hpp"

namespace roadbook::test {
namespace {

TEST(Chicago, NetworkOfAQuarterOfTheTracksLiesOnTheStreets) {
  ROADBOOK_REQUIRE_DATA(folder, "road_tracks");
  auto passes = chicago_passes(folder);
  if (passes.empty()) GTEST_SKIP() << "unzip not found";
  passes.resize(passes.size() / 4);
  RoadNetworkOptions options;
  options.reach_m = 25.0;
  options.min_passes = 3;
  const RoadNetwork network = build_road_network(passes, options);
  const auto score = compare_by_length(network, chicago_reference(folder), passes, 15.0, 3);
  EXPECT_GT(score.precision, 0.85);
  EXPECT_GT(score.recall, 0.85);
}

}  // namespace
}  // namespace roadbook::test
