#include "diagnosis/range/fitted_mixture.hpp"

namespace roadbook {

RangeMixture fit_mixture(const RangeReadings& readings, const RangeParts& parts) {
  std::vector<BeamSample> samples;
  samples.reserve(readings.samples.size());
  for (const ExpectedRange& r : readings.samples)
    samples.push_back({r.t_s, r.read_m, r.expected_m});
  return fit_range_mixture(samples, readings.max_m, {.parts = parts});
}

}  // namespace roadbook
