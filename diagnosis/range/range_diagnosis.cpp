#include "diagnosis/range/range_diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "diagnosis/inference/extended_model.hpp"
#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/numerics/size_interval.hpp"
#include "diagnosis/range/fitted_mixture.hpp"
#include "diagnosis/range/range_noise.hpp"
#include "diagnosis/range/range_noise_sizes.hpp"

namespace roadbook {
namespace {

constexpr double kMinEvidence = 3.0;  // [nats]
constexpr double kMaxRangeP = 0.01;
constexpr std::size_t kBlocks = 10;

std::size_t block_of(const RangeReadings& r, std::size_t i) {
  const double from = r.samples.front().t_s;
  const double length = std::max(r.samples.back().t_s - from, 1e-9);
  return std::min(kBlocks - 1, static_cast<std::size_t>(static_cast<double>(kBlocks) *
                                                        (r.samples[i].t_s - from) / length));
}

// Held-out gain: shares are fitted to nine tenths of the drive and evaluated on the rest. Result:
// log density with `parts` minus that with `fewer`.
HeldOutGain gain_of(const RangeReadings& readings,
                    const RangeMixture& fitted,
                    const RangeParts& parts,
                    const RangeParts& fewer) {
  std::vector<RangeDensities> densities;
  for (const ExpectedRange& r : readings.samples)
    densities.push_back(range_densities(r, fitted, readings.max_m));
  std::array<double, kBlocks> gains{};
  for (std::size_t b = 0; b < kBlocks; ++b) {
    std::vector<bool> used(densities.size());
    for (std::size_t i = 0; i < densities.size(); ++i) used[i] = block_of(readings, i) != b;
    RangeMixture with = fitted;
    RangeMixture lacking = fitted;
    fit_shares(densities, used, parts, with);
    fit_shares(densities, used, fewer, lacking);
    for (std::size_t i = 0; i < densities.size(); ++i)
      if (!used[i]) gains[b] += std::log(densities[i].of(with) / densities[i].of(lacking));
  }
  HeldOutGain gain;
  double variance = 0.0;
  for (const double g : gains) gain.total += g;
  const double mean = gain.total / kBlocks;
  for (const double g : gains) {
    variance += (g - mean) * (g - mean) / (kBlocks - 1);
    gain.positive_blocks += (g > 0.0 ? 1.0 : 0.0) / kBlocks;
  }
  const double half = 2.262 * std::sqrt(variance * kBlocks);  // t quantile, nine degrees of freedom
  gain.low = gain.total - half;
  gain.high = gain.total + half;
  gain.per_sample = gain.total / static_cast<double>(densities.size());
  return gain;
}

// Among the beams with `is_off`, the share whose neighbouring beam at the same time is off by as
// much. It is low for noise and high for moved objects and errors of the map.
template <typename IsOff>
double grouped(const RangeReadings& readings, const IsOff& is_off) {
  double all = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i + 1 < readings.samples.size(); ++i) {
    const ExpectedRange& a = readings.samples[i];
    const ExpectedRange& b = readings.samples[i + 1];
    if (!is_off(a) || a.t_s != b.t_s || b.beam != a.beam + 1) continue;
    all += 1.0;
    pairs += is_off(b) && std::abs(b.read_m - b.expected_m - a.read_m + a.expected_m) < 0.3;
  }
  return all > 20.0 ? pairs / all : 0.0;
}

double grouped_shorts(const RangeReadings& readings, const RangeMixture& m) {
  return grouped(readings,
                 [&](const ExpectedRange& r) { return r.expected_m - r.read_m > 5.0 * m.sigma_m; });
}

ChannelCheck check_of(const RangeReadings& readings, const RangeMixture& m) {
  ChannelCheck check;
  check.stream = "range0";
  check.channel = "range";
  check.rows = readings.samples.size();
  double sum = 0.0, squares = 0.0, fourth = 0.0;
  for (const ExpectedRange& r : readings.samples) {
    const double z = (r.read_m - r.expected_m) / m.sigma_m;
    sum += z;
    squares += z * z;
    fourth += z * z * z * z;
  }
  const auto n = static_cast<double>(readings.samples.size());
  check.scale = std::sqrt(squares / n);
  check.mean_z = sum / std::sqrt(n) / check.scale;
  check.kurtosis_excess =
      fourth / n / (check.scale * check.scale * check.scale * check.scale) - 3.0;
  check.tails_p = std::erfc(std::abs(check.kurtosis_excess) / std::sqrt(48.0 / n));
  return check;
}

std::string note_of_part(std::size_t part, const RangeReadings& readings, const RangeMixture& m) {
  char text[256] = "";
  if (part == kShort) {
    const double grouped = grouped_shorts(readings, m);
    std::snprintf(text, sizeof text,
                  "density falls at %.2g per metre; for %.0f %% of the short beams, the next beam "
                  "is short by the same length%s",
                  m.short_rate_per_m, 100.0 * grouped,
                  grouped > 0.3 ? ", which indicates moved objects rather than noise" : "");
  }
  return text;
}

// True if outliers are noise of the sensor. Then they are as often too long as too short, whereas
// people and clutter only shorten ranges. And they are independent between beams, whereas moved
// objects and errors of the map affect all beams in that direction.
bool are_noise(const RangeReadings& readings, const RangeMixture& m) {
  constexpr double kLeastLong = 0.33, kMostGrouped = 0.3;
  double longer = 0.0, all = 0.0;
  const auto weight = [&](const ExpectedRange& r) {
    const RangeDensities d = range_densities(r, m, readings.max_m);
    return m.share[kOutliers] * d.part[kOutliers] / d.of(m);
  };
  for (const ExpectedRange& r : readings.samples) {
    const double w = weight(r);
    all += w;
    longer += r.read_m > r.expected_m ? w : 0.0;
  }
  return longer > kLeastLong * all &&
         grouped(readings, [&](const ExpectedRange& r) { return weight(r) > 0.5; }) < kMostGrouped;
}

// Backward selection. Outliers that are not sensor noise are removed first, because they absorb
// other parts. Then the least supported part is removed until all remaining ones are supported. The
// standard error of outliers includes their confusion with other parts; that of the others does
// not.
void drop_unwanted(const RangeReadings& readings, RangeParts& parts, RangeMixture& full) {
  for (;;) {
    if (parts[kOutliers] && !are_noise(readings, full)) {
      parts[kOutliers] = false;
      full = fit_mixture(readings, parts);
    }
    std::size_t least = kRangeParts;
    double least_z = 1e300;
    for (std::size_t k = 0; k < kRangeParts; ++k) {
      if (!parts[k]) continue;
      const double z = full.share[k] / std::max(full.sigma[k], 1e-12);
      const bool wanted = full.share[k] > kLeastRangeShare && z > (k == kOutliers ? 3.0 : 5.0);
      if (wanted || z >= least_z) continue;
      least = k;
      least_z = z;
    }
    if (least == kRangeParts) return;
    parts[least] = false;
    full = fit_mixture(readings, parts);
  }
}

FoundCause found_part(const RangeReadings& readings,
                      const RangeMixture& full,
                      const RangeParts& parts,
                      std::size_t k) {
  RangeParts fewer = parts;
  fewer[k] = false;
  FoundCause cause;
  cause.effect = range_part_name(k);
  cause.unit = "1";
  // Outliers are reported as a share of the hits, the others as a share of all readings.
  const double of = k == kOutliers ? full.hit() + full.share[k] : 1.0;
  cause.noise = k == kOutliers;
  cause.size = full.share[k] / of;
  const SizeInterval interval = interval95(cause.effect, cause.size, full.sigma[k] / of);
  cause.low = interval.low;
  cause.high = interval.high;
  const double z = full.share[k] / full.sigma[k];
  cause.p = std::min(1.0, static_cast<double>(kRangeParts) * chi_squared_tail(z * z, 1));
  cause.evidence = full.log_likelihood - fit_mixture(readings, fewer).log_likelihood -
                   std::log(static_cast<double>(readings.samples.size()));
  cause.gain = gain_of(readings, full, parts, fewer);
  cause.note = note_of_part(k, readings, full);
  return cause;
}

double readings_likelihood(const RangeReadings& readings, const RangeMixture& m) {
  double sum = 0.0;
  for (const ExpectedRange& r : readings.samples)
    sum += std::log(range_densities(r, m, readings.max_m).of(m));
  return sum;
}

// A share that is too small to be reported, or zero, compared with its known value. At its bound 0
// a fit has no standard error; the likelihood at `known` gives the significance.
FoundCause share_as_fitted(const RangeReadings& readings,
                           RangeParts parts,
                           std::size_t k,
                           double known) {
  parts[k] = true;
  const RangeMixture m = fit_mixture(readings, parts);
  const double of = k == kOutliers ? m.hit() + m.share[k] : 1.0;
  RangeMixture as_known = m;
  for (double& share : as_known.share) share *= (1.0 - known * of) / (1.0 - m.share[k]);
  as_known.share[k] = known * of;
  const double lost = m.log_likelihood - readings_likelihood(readings, as_known);
  FoundCause cause;
  cause.effect = range_part_name(k);
  cause.unit = "1";
  cause.noise = k == kOutliers;
  cause.size = m.share[k] / of;
  const double sigma = std::min(
      m.sigma[k] / of, std::abs(cause.size - known) / std::sqrt(2.0 * std::max(lost, 1e-6)));
  cause.low = cause.size - kSigmas95 * sigma;
  cause.high = cause.size + kSigmas95 * sigma;
  return cause;
}

bool names_cause(const Diagnosis& d, const std::string& effect) {
  return std::any_of(d.causes.begin(), d.causes.end(),
                     [&](const FoundCause& c) { return c.effect == effect; });
}

}  // namespace

Diagnosis diagnose_ranges(const RangeReadings& readings,
                          const std::vector<std::string>& without,
                          const EffectSizes& known) {
  Diagnosis d;
  d.notes = readings.notes;
  if (readings.samples.empty()) return d;
  d.samples = readings.samples.size();
  RangeParts parts{};
  for (std::size_t k = 0; k < kRangeParts; ++k) {
    parts[k] = !holds(without, range_part_name(k));
    if (parts[k]) d.looked_for.emplace_back(range_part_name(k));
  }
  RangeMixture full = fit_mixture(readings, parts);
  d.before.push_back(check_of(readings, full));
  drop_unwanted(readings, parts, full);
  for (std::size_t k = 0; k < kRangeParts; ++k) {
    if (!parts[k]) continue;
    const FoundCause cause = found_part(readings, full, parts, k);
    if (cause.evidence < kMinEvidence || cause.p > kMaxRangeP || cause.gain.low <= 0.0) continue;
    d.causes.push_back(cause);
  }
  if (!d.causes.empty())
    d.fit_gain = full.log_likelihood - fit_mixture(readings, {}).log_likelihood;
  for (const NoiseCause& n : range_noise(readings, full)) {
    if (holds(without, n.effect)) continue;
    d.causes.push_back(found_noise(n));
  }
  correct_noise_sizes(readings, full, parts, d.causes);
  for (std::size_t k = 0; k < kRangeParts; ++k)
    if (const auto size = known.find(range_part_name(k));
        size != known.end() && holds(d.looked_for, size->first) && !names_cause(d, size->first))
      d.causes.push_back(share_as_fitted(readings, parts, k, size->second));
  sort_causes(d.causes);
  extend_model(d);
  char text[160];
  std::snprintf(text, sizeof text,
                "range0: standard deviation of hits %.3g m; %zu readings left out because their "
                "surface is uncertain",
                full.sigma_m, readings.left_out);
  d.notes.emplace_back(text);
  return d;
}

}  // namespace roadbook
