#pragma once

#include <cstddef>
#include <filesystem>

#include "base/progress.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/simulate_options.hpp"

namespace roadbook {

struct SimulationSummary {
  std::size_t frames = 0;
  std::size_t images = 0;
  double duration_s = 0.0;
  double distance_m = 0.0;
  double render_cpu_s = 0.0;  ///< CPU time of rendering and noise, PNG not counted
  std::size_t parked_cars = 0;
  std::size_t pedestrians = 0;
};

/// Drives through the scenario and writes the recorded drive to `out`: native layout
/// (docs/reference/drive_format.md), nominal calibration. The truth goes to the folder `truth/`
/// (docs/reference/simulation.md).
///
/// Same scenario, options and seed: same bytes, for any number of threads. Throws BadInput for
/// unknown effects, InvalidOption, StorageError, Interrupted.
SimulationSummary simulate(const Scenario& scenario,
                           const std::filesystem::path& out,
                           const SimulateOptions& options = {},
                           const Progress& progress = {});

}  // namespace roadbook
