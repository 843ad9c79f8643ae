#pragma once

#include <array>
#include <cstddef>

#include "sensors/range.hpp"

namespace roadbook {

// The beam model as a mixture with estimated parameters, for mapping and diagnosis. Its parts are
// those that the simulation draws from (`predict_range`), plus two parts that a map needs: wide
// hits and outliers. Source: document 001, "Resulting mixture density"; Thrun, Burgard and Fox
// 2005, section 6.3.

/// One reading of a beam.
struct BeamSample {
  double t_s = 0.0;         ///< stamp; samples ascend in time
  double read_m = 0.0;      ///< the reading, at most the maximum range
  double expected_m = 0.0;  ///< distance of the nearest surface, at most the maximum range
};

enum RangePart : std::size_t {
  kShort = 0,
  kMaximum = 1,
  kCrosstalk = 2,
  kOutliers = 3,  ///< hits with ten times the noise
  kRangeParts = 4
};
/// Name of a part: "range0.short" ...
[[nodiscard]] const char* range_part_name(std::size_t part);

/// Noise of the wide part of the hits over that of the narrow part.
inline constexpr double kWideHit = 4.0;

/// Parts of the model in addition to the hits.
using RangeParts = std::array<bool, kRangeParts>;

struct RangeMixture {
  std::array<double, kRangeParts> share{};  ///< of short, maximum, crosstalk, outliers
  double sigma_m = 0.02;                    ///< standard deviation of a hit
  double wide = 0.05;                       ///< share of wide hits: errors of map and pose
  double outlier = 10.0;                    ///< noise of outliers over `sigma_m`
  double short_rate_per_m = 0.5;
  /// Weight of a uniform density within the hits, so that the model explains any reading.
  double anything = 1e-4;
  double log_likelihood = 0.0;
  std::array<double, kRangeParts> sigma{};  ///< standard errors of the shares
  double sigma_hit = 0.0;                   ///< standard error of `hit()`; 0: not estimated
  double sigma_sigma_m = 0.0;               ///< standard error of `sigma_m`; 0: not estimated
  double sigma_rate = 0.0;                  ///< of `short_rate_per_m`; 0: not estimated

  [[nodiscard]] double hit() const {
    return 1.0 - share[kShort] - share[kMaximum] - share[kCrosstalk] - share[kOutliers];
  }
};

/// The mixture with the shares and the noise that the simulation draws from.
[[nodiscard]] RangeMixture mixture_of(const BeamMixture& shares, double sigma_m);

/// Densities of one reading for hits and for each part [1/m]; for a reading at the maximum range
/// they are probabilities.
struct RangeDensities {
  double hit = 0.0;
  std::array<double, kRangeParts> part{};

  [[nodiscard]] double of(const RangeMixture& m) const {
    double sum = m.hit() * hit;
    for (std::size_t k = 0; k < kRangeParts; ++k) sum += m.share[k] * part[k];
    return sum;
  }
};
[[nodiscard]] RangeDensities range_densities(double read_m,
                                             double expected_m,
                                             const RangeMixture& mixture,
                                             double max_m);

/// Density of a hit with standard deviation `sigma_m`, without wide hits [1/m].
[[nodiscard]] double narrow_density(const BeamSample& sample,
                                    const RangeMixture& mixture,
                                    double max_m,
                                    double sigma_m);

/// Whether the reading is the maximum range: no echo.
[[nodiscard]] inline bool is_maximum(double read_m, double max_m) { return read_m >= max_m - 1e-9; }

}  // namespace roadbook
