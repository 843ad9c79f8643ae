#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "speedmap/presence/presence_grid.hpp"
#include "speedmap/presence/visit_evidence.hpp"

namespace roadbook {

/// The experiment of [metric-semantic maps, figure 10]: seven maps of the Zurich car park, each
/// with one more visit. People use the right crossing in visits 1 to 3 and the left one in visits 4
/// to 6. Detections are the true people within range and in sight.
struct SpeedEvolution {
  PresenceGrid grid;
  std::vector<std::vector<double>> presence;         ///< of each map, by node
  std::vector<std::vector<Eigen::Vector2d>> people;  ///< seen in each visit
  /// Mean presence at the crossings over a lane, and over lanes away from crossings.
  std::vector<double> left;
  std::vector<double> right;
  std::vector<double> lanes;
};

/// Runs the experiment. `seen` has detections for each visit in place of the true people. For
/// visits without detections, the true people are used.
[[nodiscard]] SpeedEvolution zurich_evolution(
    const PresenceOptions& options,
    const SightOptions& sight,
    std::uint64_t seed,
    const std::vector<std::vector<VisitFrame>>& seen = {});

}  // namespace roadbook
