#pragma once

#include <vector>

#include "base/progress.hpp"
#include "mapping/pipeline/map_stages.hpp"

namespace roadbook {

/// The stages of a map from which single loops can be removed.
struct LoopedMap {
  MappingInput input;
  std::vector<LoopClosure> loops;  ///< as `relax_poses` left them
  Relaxed relaxed;
  Adjusted adjusted;
};

/// Finds loops, relaxes and adjusts. Throws the exceptions of these stages.
[[nodiscard]] LoopedMap map_with_loops(MappingInput input,
                                       const MapOptions& options,
                                       const Progress& progress = {});

/// The largest movement of a pose without one loop, in standard deviations of the map.
struct RemovedLoop {
  std::size_t loop = 0;   ///< index in LoopedMap::loops
  double position = 0.0;  ///< Mahalanobis distance of the three coordinates
  double heading = 0.0;
};

/// Indices of up to `count` accepted loops, drawn by `seed`; ascending.
[[nodiscard]] std::vector<std::size_t> drawn_loops(const LoopedMap& map,
                                                   std::size_t count,
                                                   std::uint64_t seed);

/// Relaxes the pose graph without the loop; with `adjusts` also adjusts the bundle without it.
/// Requires known covariances in `map.adjusted`.
[[nodiscard]] RemovedLoop remove_loop(const LoopedMap& map,
                                      std::size_t loop,
                                      bool adjusts,
                                      const MapOptions& options,
                                      const Progress& progress = {});

}  // namespace roadbook
