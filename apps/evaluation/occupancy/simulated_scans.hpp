#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "mapping/occupancy/scans.hpp"
#include "sensors/effects.hpp"
#include "workflows/occupancy/true_surfaces.hpp"

namespace roadbook {

/// Scans of a simulated drive at its true poses, with the truth around it.
struct SimulatedScans {
  std::vector<RangeScan> scans;
  double max_m = 10.0;
  Surfaces surfaces;                    ///< of the place, without what moves
  std::vector<Eigen::Vector2d> walked;  ///< places of people during the drive
};

struct SimulatedScansOptions {
  std::string place = "zurich";
  std::string size = "full";
  int visit = 0;
  bool noise = true;
  EffectSizes effects;
  std::uint64_t seed = 1;
  int num_threads = 0;
};

/// Simulates a drive without images in `folder`, which it replaces, and reads it.
[[nodiscard]] SimulatedScans simulate_scans(const std::filesystem::path& folder,
                                            const SimulatedScansOptions& options,
                                            const Progress& progress);

/// Twelve ultrasonic sensors around the vehicle, each with a cone of `cone_rad`, at the poses of
/// the scans: each reads the nearest surface within its cone, with the noise of a hit and the
/// shares of the mixture. `beam` numbers the sensor.
[[nodiscard]] std::vector<RangeScan> wide_scans(const SimulatedScans& drive,
                                                double cone_rad,
                                                double max_m,
                                                double sigma_m,
                                                const BeamMixture& shares,
                                                std::uint64_t seed,
                                                int num_threads);

/// A scanner that fails: 20 % of the readings lost (maximum range), 5 % short, a third of the beams
/// dead.
[[nodiscard]] std::vector<RangeScan> with_failures(const std::vector<RangeScan>& scans,
                                                   double max_m,
                                                   std::uint64_t seed);

}  // namespace roadbook
