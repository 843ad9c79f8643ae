#pragma once

#include <array>
#include <vector>

#include "diagnosis/range/range_readings.hpp"
#include "sensors/range.hpp"

namespace roadbook {

// Beam model of a range sensor, fitted by expectation maximisation, with standard errors of the
// weights. Source: [environment representation, beam model]; Thrun, Burgard and Fox 2005, table
// 6.2.

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
  double log_likelihood = 0.0;
  std::array<double, kRangeParts> sigma{};  ///< standard errors of the shares, from blocks of 1 s

  [[nodiscard]] double hit() const {
    return 1.0 - share[kShort] - share[kMaximum] - share[kCrosstalk] - share[kOutliers];
  }
};

/// Densities of one reading for hits and for each part [1/m].
struct RangeDensities {
  double hit = 0.0;
  std::array<double, kRangeParts> part{};

  [[nodiscard]] double of(const RangeMixture& m) const {
    double sum = m.hit() * hit;
    for (std::size_t k = 0; k < kRangeParts; ++k) sum += m.share[k] * part[k];
    return sum;
  }
};
/// Densities of a reading. Hits include a uniform density of weight 1e-4 over the whole range, so
/// that the nominal model explains any reading.
[[nodiscard]] RangeDensities range_densities(const ExpectedRange& reading,
                                             const RangeMixture& mixture,
                                             double max_m);

[[nodiscard]] RangeMixture fit_mixture(const RangeReadings& readings, const RangeParts& parts);

/// Refits the shares alone to the readings marked in `used`, with given densities.
void fit_shares(const std::vector<RangeDensities>& densities,
                const std::vector<bool>& used,
                const RangeParts& parts,
                RangeMixture& mixture);

}  // namespace roadbook
