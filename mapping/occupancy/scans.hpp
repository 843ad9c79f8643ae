#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sensors/range/range_fit.hpp"

namespace roadbook {

/// One beam of a scan in the map's plane.
struct ScanBeam {
  std::uint32_t beam = 0;
  Eigen::Vector2f along = Eigen::Vector2f::UnitX();  ///< unit
  double read_m = 0.0;  ///< horizontal length; at the maximum range: no echo
};

/// The readings of one instant. Ascending in time within a drive.
struct RangeScan {
  std::int64_t t_ns = 0;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< of all beams, map frame [m]
  std::vector<ScanBeam> beams;
};

/// Readings with the distances expected from the other readings of the drive, where those determine
/// them (mapping/occupancy/range_map.hpp).
[[nodiscard]] std::vector<BeamSample> expected_samples(std::span<const RangeScan> scans,
                                                       double max_m,
                                                       double cell_m = 0.1);

/// The forward model fitted to the scans of a drive: short readings, maximum range, crosstalk, hits
/// with wide ones, which errors of map and poses need. `enough`: false if fewer than 500 readings
/// have an expected distance; the model is then the nominal one with `sigma_m`.
struct FittedBeams {
  RangeMixture mixture;
  std::size_t samples = 0;
  bool enough = false;
};
[[nodiscard]] FittedBeams fit_beams(std::span<const RangeScan> scans, double max_m, double sigma_m);

/// Surfaces that a beam meets per metre: readings with an echo over the summed length of all
/// beams. The maximum likelihood rate of an exponential distribution, cut at the maximum range.
[[nodiscard]] double surfaces_per_m(std::span<const RangeScan> scans, double max_m);

}  // namespace roadbook
