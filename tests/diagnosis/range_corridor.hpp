#pragma once

#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "mapping/occupancy/range_map.hpp"

namespace roadbook::test {

/// Beams in a corridor between y = 0 and y = 4, the far wall at x = 20.
inline std::vector<RangeBeam> corridor() {
  Random random(1);
  std::vector<RangeBeam> beams;
  for (int k = 0; k < 200; ++k)
    for (std::size_t b = 0; b < 60; ++b) {
      RangeBeam beam;
      beam.t_s = 0.1 * k;
      beam.beam = b;
      beam.origin = {0.05 * k, 2.0};
      const double a = -1.5 + 0.05 * static_cast<double>(b) + 0.002 * k;
      beam.along = {std::cos(a), std::sin(a)};
      double r = beam.along.x() > 0.0 ? (20.0 - beam.origin.x()) / beam.along.x() : 1e9;
      if (std::abs(beam.along.y()) > 1e-9) r = std::min(r, 2.0 / std::abs(beam.along.y()));
      beam.range_m = std::min(r + 0.01 * random.normal(), 25.0);
      beams.push_back(beam);
    }
  return beams;
}

}  // namespace roadbook::test
