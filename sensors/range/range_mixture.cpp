#include "sensors/range/range_mixture.hpp"

namespace roadbook {

const char* range_part_name(std::size_t part) {
  constexpr std::array<const char*, kRangeParts> kNames{"range0.short", "range0.maximum",
                                                        "range0.crosstalk", "range0.outliers"};
  return kNames[part];
}

RangeMixture mixture_of(const BeamMixture& shares, double sigma_m) {
  RangeMixture m;
  m.share = {shares.shortened, shares.maximum, shares.crosstalk, 0.0};
  m.sigma_m = sigma_m;
  m.wide = 0.0;
  m.short_rate_per_m = shares.short_rate_per_m;
  return m;
}

double narrow_density(const BeamSample& sample,
                      const RangeMixture& mixture,
                      double max_m,
                      double sigma_m) {
  return beam_density(sample.read_m, sample.expected_m, sigma_m, mixture.short_rate_per_m, max_m)
      .hit;
}

RangeDensities range_densities(double read_m,
                               double expected_m,
                               const RangeMixture& mixture,
                               double max_m) {
  const BeamSample sample{0.0, read_m, expected_m};
  const BeamDensity narrow =
      beam_density(read_m, expected_m, mixture.sigma_m, mixture.short_rate_per_m, max_m);
  const double wide =
      mixture.wide > 0.0 ? narrow_density(sample, mixture, max_m, kWideHit * mixture.sigma_m) : 0.0;
  RangeDensities d;
  const double anything = is_maximum(read_m, max_m) ? 1.0 : 1.0 / max_m;
  d.hit = (1.0 - mixture.anything) * ((1.0 - mixture.wide) * narrow.hit + mixture.wide * wide) +
          mixture.anything * anything;
  d.part = {narrow.shortened, narrow.maximum, narrow.crosstalk,
            narrow_density(sample, mixture, max_m, mixture.outlier * mixture.sigma_m)};
  return d;
}

}  // namespace roadbook
