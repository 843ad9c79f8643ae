#include "diagnosis/range_diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "diagnosis/range_mixture.hpp"
#include "diagnosis/score_table.hpp"

namespace roadbook {
namespace {

constexpr std::array<const char*, kRangeParts> kNames{"range0.short", "range0.maximum",
                                                      "range0.crosstalk"};
constexpr double kMinEvidence = 3.0;  // [nats]
constexpr double kMaxP = 0.01;
constexpr std::size_t kBlocks = 10;

std::size_t block_of(const RangeReadings& r, std::size_t i) {
  const double from = r.samples.front().t_s;
  const double length = std::max(r.samples.back().t_s - from, 1e-9);
  return std::min(kBlocks - 1, static_cast<std::size_t>(static_cast<double>(kBlocks) *
                                                        (r.samples[i].t_s - from) / length));
}

// Shares fitted to nine tenths of the drive, judged on the rest: log density with `parts` less that
// with `fewer`.
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
  const double half = 2.262 * std::sqrt(variance * kBlocks);  // Student, nine degrees of freedom
  gain.low = gain.total - half;
  gain.high = gain.total + half;
  gain.per_sample = gain.total / static_cast<double>(densities.size());
  return gain;
}

// How often the next beam of the same instant is short too: noise is not, a moving thing is.
double grouped_shorts(const RangeReadings& readings, const RangeMixture& m) {
  double shorts = 0.0, pairs = 0.0;
  const auto is_short = [&](const ExpectedRange& r) {
    return r.expected_m - r.read_m > 5.0 * m.sigma_m;
  };
  for (std::size_t i = 0; i + 1 < readings.samples.size(); ++i) {
    const ExpectedRange& a = readings.samples[i];
    const ExpectedRange& b = readings.samples[i + 1];
    if (!is_short(a) || a.t_s != b.t_s || b.beam != a.beam + 1) continue;
    shorts += 1.0;
    pairs += is_short(b) && std::abs(b.read_m - a.read_m) < 0.3;
  }
  return shorts > 20.0 ? pairs / shorts : 0.0;
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

std::string note_of(std::size_t part, const RangeReadings& readings, const RangeMixture& m) {
  char text[160] = "";
  if (part == kShort) {
    const double grouped = grouped_shorts(readings, m);
    std::snprintf(text, sizeof text,
                  "thin out by %.2g per metre; beside a short beam the next one is short as far in "
                  "%.0f %%%s",
                  m.short_rate_per_m, 100.0 * grouped,
                  grouped > 0.3 ? ": things that moved, rather than noise" : "");
  }
  return text;
}

}  // namespace

Diagnosis diagnose_ranges(const RangeReadings& readings, const std::vector<std::string>& without) {
  Diagnosis d;
  d.notes = readings.notes;
  if (readings.samples.empty()) return d;
  d.samples = readings.samples.size();
  RangeParts parts{};
  for (std::size_t k = 0; k < kRangeParts; ++k) {
    parts[k] = std::find(without.begin(), without.end(), kNames[k]) == without.end();
    if (parts[k]) d.looked_for.emplace_back(kNames[k]);
  }
  RangeMixture full = fit_mixture(readings, parts);
  d.before.push_back(check_of(readings, full));
  // Backwards: the least wanted part goes until all that are left are wanted.
  for (bool gone = true; gone;) {
    gone = false;
    std::size_t least = kRangeParts;
    double least_z = 1e300;
    for (std::size_t k = 0; k < kRangeParts; ++k) {
      if (!parts[k]) continue;
      const double z = full.share[k] / std::max(full.sigma[k], 1e-12);
      const bool wanted = full.share[k] > kLeastRangeShare && z > 5.0;
      if (wanted || z >= least_z) continue;
      least = k;
      least_z = z;
    }
    if (least == kRangeParts) break;
    parts[least] = false;
    full = fit_mixture(readings, parts);
    gone = true;
  }
  for (std::size_t k = 0; k < kRangeParts; ++k) {
    if (!parts[k]) continue;
    RangeParts fewer = parts;
    fewer[k] = false;
    FoundCause cause;
    cause.effect = kNames[k];
    cause.unit = "1";
    cause.size = full.share[k];
    cause.low = cause.size - 1.96 * full.sigma[k];
    cause.high = cause.size + 1.96 * full.sigma[k];
    const double z = full.share[k] / full.sigma[k];
    cause.p = std::min(1.0, static_cast<double>(kRangeParts) * chi_squared_tail(z * z, 1));
    cause.evidence = full.log_likelihood - fit_mixture(readings, fewer).log_likelihood -
                     std::log(static_cast<double>(readings.samples.size()));
    cause.gain = gain_of(readings, full, parts, fewer);
    cause.note = note_of(k, readings, full);
    if (cause.evidence < kMinEvidence || cause.p > kMaxP || cause.gain.low <= 0.0) continue;
    d.causes.push_back(cause);
    d.extended[cause.effect] = cause.size;
  }
  if (!d.causes.empty())
    d.fit_gain = full.log_likelihood - fit_mixture(readings, {}).log_likelihood;
  std::stable_sort(d.causes.begin(), d.causes.end(), [](const FoundCause& a, const FoundCause& b) {
    return a.evidence > b.evidence;
  });
  char text[120];
  std::snprintf(text, sizeof text,
                "range0: hits scatter by %.3g m; %zu readings left out where no surface is certain",
                full.sigma_m, readings.left_out);
  d.notes.emplace_back(text);
  return d;
}

}  // namespace roadbook
