#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exchange/lanelets.hpp"

namespace roadbook {

// Lanelets as CommonRoad knows them: each is driven one way, and names those that follow it.

struct DirectedLanelet {
  Lanelet lanelet;                      ///< `both_ways` is false
  std::vector<std::size_t> successors;  ///< indices
  std::vector<std::size_t> predecessors;
};

/// Lanelets of a network, two for each that is driven both ways.
[[nodiscard]] std::vector<DirectedLanelet> directed_lanelets(const LaneletNetwork& network);

/// The lanelet that takes longest to reach from one, by the speed limits; itself where none does.
struct FarthestLanelet {
  std::size_t index = 0;
  double time_s = 0.0;  ///< to its end, from the begin of the first
};
[[nodiscard]] FarthestLanelet farthest_from(const std::vector<DirectedLanelet>& lanelets,
                                            std::size_t from);

}  // namespace roadbook
