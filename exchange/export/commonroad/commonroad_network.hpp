#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exchange/export/planner/lanelets.hpp"

namespace roadbook {

// Lanelets for CommonRoad: each has one driving direction and lists its successors and
// predecessors.

struct DirectedLanelet {
  Lanelet lanelet;                      ///< `both_ways` is false
  std::vector<std::size_t> successors;  ///< indices
  std::vector<std::size_t> predecessors;
};

/// Lanelets of a network, two for each that is driven both ways.
[[nodiscard]] std::vector<DirectedLanelet> directed_lanelets(const LaneletNetwork& network);

/// The quickest route by the speed limits from the begin of one lanelet to the end of another.
struct LaneletTrip {
  std::size_t from = 0;
  std::size_t to = 0;
  double time_s = 0.0;
};

/// Returns the trip with the longest time, among those from up to 50 evenly chosen lanelets.
/// `lanelets` must not be empty.
[[nodiscard]] LaneletTrip longest_trip(const std::vector<DirectedLanelet>& lanelets);

}  // namespace roadbook
