#pragma once

#include <array>
#include <vector>

#include "diagnosis/range/range_readings.hpp"
#include "sensors/range.hpp"

namespace roadbook {

// The beam model fitted to readings by expectation and maximisation (Thrun, Burgard, Fox:
// Probabilistic Robotics, table 6.2), with the weights' information.

enum RangePart : std::size_t {
  kShort = 0,
  kMaximum = 1,
  kCrosstalk = 2,
  kOutliers = 3,  ///< hits with ten times the noise
  kRangeParts = 4
};
/// "range0.short", ...
[[nodiscard]] const char* range_part_name(std::size_t part);

/// Noise of the wide part of the hits over that of the rest.
inline constexpr double kWideHit = 4.0;

/// Which parts beside the hits the model has.
using RangeParts = std::array<bool, kRangeParts>;

struct RangeMixture {
  std::array<double, kRangeParts> share{};  ///< of short, maximum, crosstalk, outliers
  double sigma_m = 0.02;                    ///< of a hit
  double wide = 0.05;     ///< share of hits with kWideHit times that: errors of map and pose
  double outlier = 10.0;  ///< noise of outliers over `sigma_m`
  double short_rate_per_m = 0.5;
  double log_likelihood = 0.0;
  std::array<double, kRangeParts> sigma{};  ///< of the shares, from the scatter of 1 s blocks

  [[nodiscard]] double hit() const {
    return 1.0 - share[kShort] - share[kMaximum] - share[kCrosstalk] - share[kOutliers];
  }
};

/// Densities of one reading under ordinary hits and the parts.
struct RangeDensities {
  double hit = 0.0;
  std::array<double, kRangeParts> part{};

  [[nodiscard]] double of(const RangeMixture& m) const {
    double sum = m.hit() * hit;
    for (std::size_t k = 0; k < kRangeParts; ++k) sum += m.share[k] * part[k];
    return sum;
  }
};
/// The nominal model, hits alone, grants anything a density of 1e-4 over the whole range.
[[nodiscard]] RangeDensities range_densities(const ExpectedRange& reading,
                                             const RangeMixture& mixture,
                                             double max_m);

[[nodiscard]] RangeMixture fit_mixture(const RangeReadings& readings, const RangeParts& parts);

/// Shares alone refitted to some readings of known densities.
void fit_shares(const std::vector<RangeDensities>& densities,
                const std::vector<bool>& used,
                const RangeParts& parts,
                RangeMixture& mixture);

}  // namespace roadbook
