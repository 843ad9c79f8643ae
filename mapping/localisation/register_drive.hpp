#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "mapping/map.hpp"

namespace roadbook {

// Localisation of a later drive in a map that does not change ("frozen map").

struct FrozenMapOptions {
  int max_hamming = 120;       ///< largest distance of descriptors of the two maps, of 512 bits
  double max_ratio = 0.8;      ///< nearest over second-nearest descriptor distance
  std::size_t queries = 3000;  ///< landmarks of the drive that are searched for in the map
  double near_m = 0.6;         ///< largest error of a pair that agrees with one rigid motion
  double far_m = 3.0;          ///< the same if the frozen map is scaled or bent
  std::size_t fewest = 20;     ///< pairs that must agree
  double local_m = 8.0;        ///< radius of the landmarks around a pose that move the pose
  int rounds = 2;              ///< of finding pairs and moving poses
};

struct LocalisedDrive {
  Map map;          ///< the frozen map, unchanged, with the drive as a further session
  int session = 0;  ///< of the drive
};

/// Localises a drive in the map `frozen`. `own` is the map made from this drive alone. Each pose of
/// the drive moves with the landmarks around it to the positions of the same landmarks in `frozen`.
/// Landmarks of the two maps are not joined. Empty if the drive is not found in the map.
/// Deterministic.
[[nodiscard]] std::optional<LocalisedDrive> localise_in(const Map& frozen,
                                                        const Map& own,
                                                        const FrozenMapOptions& options = {});

}  // namespace roadbook
