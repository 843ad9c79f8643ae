#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/evaluation/covariance/coverage.hpp"
#include "base/progress.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// Whether the covariances of maps can be believed: simulated drives of several image sizes, with
// and without loops, with sound sensors and with a hidden error, are mapped and compared with the
// truth.

/// Drives of one kind.
struct CoverageKind {
  std::string name;  ///< "loops 320x240"
  double image_scale = 0.5;
  double seconds = 0.0;  ///< 0: the whole drive, two rounds
  EffectSizes effects;   ///< hidden errors of sensors
  std::string fault;     ///< of the recording (drive_fault.hpp); empty: none
};

/// All kinds; `quick`: the middle image size alone.
[[nodiscard]] std::vector<CoverageKind> coverage_kinds(bool quick);

/// What became of the drives of one kind.
struct CoverageTally {
  std::size_t drives = 0;
  std::size_t refused = 0;  ///< no map
  Coverage coverage;        ///< of the other drives
  void add(const CoverageTally& other);
};

/// Simulates one drive on the small place `zurich`, maps it and compares the map with the truth.
/// The seed draws the place's surfaces and the noise, so that drives of different seeds have
/// different errors. Deterministic on any number of threads. Throws the exceptions of `simulate`
/// and `map_drives`, except that a refused map counts as one.
[[nodiscard]] CoverageTally coverage_of_drive(const CoverageKind& kind,
                                              std::uint64_t seed,
                                              int num_threads,
                                              const Progress& progress = {});

}  // namespace roadbook
