#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "mapping/map.hpp"

namespace roadbook {

// A map that does not change, and a later drive that is localised in it.

struct FrozenMapOptions {
  int max_hamming = 120;       ///< of 512 bits, between landmarks of the two maps
  double max_ratio = 0.8;      ///< of the distance to the second nearest
  std::size_t queries = 3000;  ///< landmarks of the drive that are looked for in the map
  double near_m = 0.6;         ///< how far pairs may be off that agree with one rigid motion
  double far_m = 3.0;          ///< how far where the frozen map is scaled or bent
  std::size_t fewest = 20;     ///< pairs that must agree
  double local_m = 8.0;        ///< landmarks so near to a pose tell how it lies in the map
  int rounds = 2;              ///< of finding pairs and moving poses
};

struct LocalisedDrive {
  Map map;          ///< the frozen map, unchanged, with the drive as a further session
  int session = 0;  ///< of the drive
};

/// The drive of `own` (the map made of it alone) localised in `frozen`: each of its poses moves
/// with the landmarks about it to where the frozen map has the same ones; landmarks of neither are
/// joined. Nothing where the drive is not found in the map. Deterministic.
[[nodiscard]] std::optional<LocalisedDrive> localise_in(const Map& frozen,
                                                        const Map& own,
                                                        const FrozenMapOptions& options = {});

}  // namespace roadbook
