#include "mapping/occupancy/scans.hpp"

#include <algorithm>

#include "mapping/occupancy/range_map.hpp"

namespace roadbook {

std::vector<BeamSample> expected_samples(std::span<const RangeScan> scans,
                                         double max_m,
                                         double cell_m) {
  std::vector<RangeBeam> beams;
  const std::int64_t start = scans.empty() ? 0 : scans.front().t_ns;
  for (const RangeScan& scan : scans)
    for (const ScanBeam& b : scan.beams) {
      RangeBeam beam;
      beam.t_s = 1e-9 * static_cast<double>(scan.t_ns - start);
      beam.beam = b.beam;
      beam.origin = scan.origin;
      beam.along = b.along.cast<double>();
      beam.range_m = b.read_m;
      beams.push_back(beam);
    }
  const RangeMap map(beams, max_m, cell_m);
  std::vector<BeamSample> samples;
  for (const RangeBeam& beam : beams)
    if (const auto met = map.surface(beam))
      samples.push_back({beam.t_s, std::min(beam.range_m, max_m), met->range_m});
  return samples;
}

FittedBeams fit_beams(std::span<const RangeScan> scans, double max_m, double sigma_m) {
  constexpr std::size_t kFewest = 500;
  const std::vector<BeamSample> samples = expected_samples(scans, max_m);
  FittedBeams fitted;
  fitted.samples = samples.size();
  fitted.enough = samples.size() >= kFewest;
  if (!fitted.enough) {
    fitted.mixture = mixture_of({}, sigma_m);
    return fitted;
  }
  RangeFitOptions options;
  options.parts = {true, true, true, false};
  options.starts = 3;
  options.to_the_maximum = true;
  fitted.mixture = fit_range_mixture(samples, max_m, options);
  return fitted;
}

double surfaces_per_m(std::span<const RangeScan> scans, double max_m) {
  double echoes = 0.0, length_m = 0.0;
  for (const RangeScan& scan : scans)
    for (const ScanBeam& b : scan.beams) {
      length_m += std::min(b.read_m, max_m);
      echoes += is_maximum(b.read_m, max_m) ? 0.0 : 1.0;
    }
  return std::clamp(echoes / std::max(length_m, 1e-3), 1e-3, 5.0);
}

}  // namespace roadbook
