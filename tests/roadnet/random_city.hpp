#pragma once

#include <cstdint>
#include <vector>

#include "roadnet/network.hpp"
#include "tests/roadnet/street_score.hpp"

namespace roadbook::test {

// A city of crooked blocks and the positions of vehicles that drive through it: the truth that
// street maps of real cities are not.

struct RandomCity {
  double block_m = 200.0;
  int blocks = 7;            ///< each way
  double noise_m = 10.0;     ///< standard deviation of a position, in x and in y
  double interval_s = 30.0;  ///< between positions
  int drives = 200;
  std::uint64_t seed = 1;
};

struct CityTracks {
  StreetMap map;
  DrivenTimes driven;
  std::vector<DrivenPass> passes;
};

/// Streets: a grid turned by 17 degrees, far from the origin like UTM coordinates. Its corners are
/// displaced by a tenth of a block, and one street in seven is missing. Drives: each drive goes
/// between random corners on a separate random way, at 6 to 12 m/s, with a stop of 10 to 40 s at
/// three corners of ten. The first position comes at a random time.
[[nodiscard]] CityTracks drive_through(const RandomCity& city);

}  // namespace roadbook::test
