#include "mapping/loops/graph_loops.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace roadbook {
namespace {

constexpr int kPlaces = 200;

// Loops from every keyframe of `laps` laps to the same place in all earlier laps.
std::vector<LoopClosure> loops_of_laps(int laps) {
  std::vector<LoopClosure> loops;
  for (int to = kPlaces; to < laps * kPlaces; ++to)
    for (int from = to % kPlaces; from < to; from += kPlaces) {
      LoopClosure loop;
      loop.edge.from = from;
      loop.edge.to = to;
      loop.edge.accepted = to % 7 != 0;
      loops.push_back(loop);
    }
  return loops;
}

TEST(GraphLoops, OfFewLapsAllAcceptedOnesEnter) {
  const auto loops = loops_of_laps(4);
  std::size_t accepted = 0;
  for (const LoopClosure& loop : loops) accepted += loop.edge.accepted ? 1U : 0U;
  const auto kept = loops_of_graph(loops, std::vector<int>(4 * kPlaces, 0));
  EXPECT_EQ(kept.size(), accepted);
  for (const std::size_t i : kept) EXPECT_TRUE(loops[i].edge.accepted);
}

TEST(GraphLoops, OfManyLapsSomeToTheLastPassEnter) {
  constexpr int kLaps = 20;
  const auto loops = loops_of_laps(kLaps);
  const auto kept = loops_of_graph(loops, std::vector<int>(kLaps * kPlaces, 0));
  EXPECT_LE(kept.size(), 1000U);
  std::map<int, int> of_lap;
  for (const std::size_t i : kept) {
    EXPECT_TRUE(loops[i].edge.accepted);
    EXPECT_EQ(loops[i].edge.from, loops[i].edge.to - kPlaces);
    ++of_lap[loops[i].edge.to / kPlaces];
  }
  for (int lap = 1; lap < kLaps; ++lap)
    EXPECT_NEAR(of_lap[lap], 1000.0 / kLaps, 0.25 * 1000.0 / kLaps);
}

// A short segment amid the last lap: few loops join it to the others, and all of them enter.
TEST(GraphLoops, AShortSegmentKeepsAllItsVotes) {
  constexpr int kLaps = 20;
  constexpr int kBegin = 19 * kPlaces + 102;
  constexpr int kEnd = kBegin + 5;
  std::vector<int> segment;
  for (int k = 0; k < kLaps * kPlaces; ++k) segment.push_back(k < kBegin ? 0 : k < kEnd ? 1 : 2);
  const auto loops = loops_of_laps(kLaps);
  const auto joins = [&](const LoopClosure& loop) {
    return loop.edge.accepted && loop.edge.to >= kBegin && loop.edge.to < kEnd;
  };
  const auto all = std::count_if(loops.begin(), loops.end(), joins);
  EXPECT_GT(all, 50);
  EXPECT_LE(all, 100);
  const auto kept = loops_of_graph(loops, segment);
  EXPECT_EQ(std::count_if(kept.begin(), kept.end(), [&](auto i) { return joins(loops[i]); }), all);
  EXPECT_LT(kept.size(), 1500U);
}

}  // namespace
}  // namespace roadbook
