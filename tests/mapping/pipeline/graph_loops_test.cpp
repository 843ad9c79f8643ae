#include "mapping/loops/graph_loops.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

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

// A segment that only loops join to the earlier ones stays joined to each of them.
TEST(GraphLoops, SegmentsStayJoined) {
  constexpr int kLaps = 20;
  std::vector<int> segment;
  for (int k = 0; k < kLaps * kPlaces; ++k) segment.push_back(k < 3 * kPlaces ? 0 : 1);
  const auto loops = loops_of_laps(kLaps);
  std::set<int> joined;  // groups of segment 1 with a loop to segment 0
  for (const std::size_t i : loops_of_graph(loops, segment))
    if (loops[i].edge.to >= 3 * kPlaces && loops[i].edge.from < 3 * kPlaces)
      joined.insert(loops[i].edge.to / 10);
  EXPECT_EQ(joined.size(), static_cast<std::size_t>((kLaps - 3) * kPlaces / 10));
}

}  // namespace
}  // namespace roadbook
