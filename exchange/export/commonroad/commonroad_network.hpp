#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exchange/export/planner/lanelets.hpp"

namespace roadbook {

// Lanelets as CommonRoad knows them: each is driven one way, and names those that follow it.

struct DirectedLanelet {
  Lanelet lanelet;                      ///< `both_ways` is false
  std::vector<std::size_t> successors;  ///< indices
  std::vector<std::size_t> predecessors;
};

/// Lanelets of a network, two for each that is driven both ways.
[[nodiscard]] std::vector<DirectedLanelet> directed_lanelets(const LaneletNetwork& network);

/// A way from the begin of one lanelet to the end of another, the quickest by the speed limits.
struct LaneletTrip {
  std::size_t from = 0;
  std::size_t to = 0;
  double time_s = 0.0;
};

/// The trip that takes longest, of those from up to 50 lanelets evenly taken; `lanelets` is not
/// empty.
[[nodiscard]] LaneletTrip longest_trip(const std::vector<DirectedLanelet>& lanelets);

}  // namespace roadbook
