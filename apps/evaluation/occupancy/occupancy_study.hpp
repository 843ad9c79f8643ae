#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/evaluation/occupancy/grid_rules.hpp"
#include "base/progress.hpp"
#include "workflows/occupancy/occupancy_score.hpp"

namespace roadbook {

// Occupancy grids of a simulated place by each rule, against the true surfaces at the height of the
// scanner. The three demonstrations are those of document 001: an ideal sensor, one with Gaussian
// noise, one with the full mixture of errors.

struct OccupancyCase {
  std::string sensor;  ///< ideal, gaussian, mixture, failing, wide beams
  std::string rule;
  OccupancyTruth score;
  double temper = 1.0;
  double trails = 0.0;  ///< share of the free cells that people crossed which are called occupied
  std::size_t crossed = 0;  ///< those cells
};

struct OccupancyStudyOptions {
  std::string place = "stuttgart";  ///< even ground: a scanner sees one plane of it
  std::string size = "full";
  std::uint64_t seed = 1;
  int num_threads = 0;
};

/// Simulates the drives in folders of `out`, and writes the pictures `ideal.png`, `gaussian.png`,
/// `mixture.png`, `wide.png` and the chart `calibration.svg` there.
[[nodiscard]] std::vector<OccupancyCase> study_occupancy(const std::filesystem::path& out,
                                                         const OccupancyStudyOptions& options,
                                                         const Progress& progress);

}  // namespace roadbook
