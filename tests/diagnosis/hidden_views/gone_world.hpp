#pragma once

#include <cstdint>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook::test {

// Maps of two drives around a lap between objects, generated in milliseconds without images, to
// test the rates of redetection. Visibility and redetection follow rules that differ from those of
// diagnosis.

struct GoneWorldOptions {
  std::uint64_t seed = 1;
  double length_m = 80.0;    ///< of the lap
  double per_square = 30.0;  ///< landmarks in 4 m^2 of a thing, seen or not
  double share_gone = 0.0;   ///< of the things, taken away before the second drive
};

struct GoneWorld {
  Map map;                              ///< session 0: the earlier drive, 1: the later
  std::vector<int> thing_of;            ///< of each landmark of the map; -1: of the ground between
  std::vector<bool> gone;               ///< of each thing
  std::vector<Eigen::Vector2d> middle;  ///< of each thing [m], map frame
};

/// Deterministic. The seed also determines how far and how well cameras see, what occludes an
/// object for some metres in one drive, the rate of redetection (43 to 82 %), its variation between
/// objects and over the place (0 to 0.4 in log odds each), and a stretch with half of the views.
[[nodiscard]] GoneWorld make_gone_world(const GoneWorldOptions& options);

}  // namespace roadbook::test
