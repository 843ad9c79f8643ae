#include "diagnosis/range/range_mixture.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

// Outliers have ten times the noise by definition. The scatter of hits also contains errors of map
// and pose, so their ratio to it may be smaller.
constexpr double kLeastOutlier = 6.0;
constexpr double kMostOutlier = 12.0;
constexpr double kFloor = 1e-4;

double narrow_density(const ExpectedRange& r, const RangeMixture& m, double max_m, double sigma) {
  return beam_density(r.read_m, r.expected_m, sigma, m.short_rate_per_m, max_m).hit;
}

std::vector<RangeDensities> all_densities(const RangeReadings& readings, const RangeMixture& m) {
  std::vector<RangeDensities> densities;
  densities.reserve(readings.samples.size());
  for (const ExpectedRange& r : readings.samples)
    densities.push_back(range_densities(r, m, readings.max_m));
  return densities;
}

// Maximum likelihood rate of an exponential truncated at each reading's expected distance, from
// weighted readings. Bisection in the log of the rate.
double rate_of(const RangeReadings& readings, const std::vector<double>& weight) {
  const auto slope = [&](double rate) {
    double sum = 0.0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
      if (weight[i] < 1e-6) continue;
      const ExpectedRange& r = readings.samples[i];
      const double x = rate * r.expected_m;
      const double cut = x > 1e-6 ? r.expected_m / std::expm1(x) : 1.0 / rate;
      sum += weight[i] * (1.0 / rate - r.read_m - cut);
    }
    return sum;
  };
  double low = std::log(0.02);
  double high = std::log(20.0);
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(std::exp(middle)) > 0.0 ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

// Updates scale and wide share of the hits and the rate of short readings from the
// responsibilities.
void update_shapes(const RangeReadings& readings,
                   const std::vector<RangeDensities>& densities,
                   RangeMixture& m) {
  double squares = 0.0, hits = 0.0, wide = 0.0, far_squares = 0.0, far = 0.0;
  std::vector<double> shortened(readings.samples.size());
  for (std::size_t i = 0; i < readings.samples.size(); ++i) {
    const ExpectedRange& r = readings.samples[i];
    const double all = densities[i].of(m);
    // The uniform part takes readings that no hit explains; it must not affect the scale of the
    // hits.
    const double anything = r.read_m >= readings.max_m - 1e-9 ? 1.0 : 1.0 / readings.max_m;
    const double hit = m.hit() * (densities[i].hit - kFloor * anything) / all;
    shortened[i] = m.share[kShort] * densities[i].part[kShort] / all;
    if (r.read_m >= readings.max_m - 1e-9) continue;
    const double broad = m.wide * narrow_density(r, m, readings.max_m, kWideHit * m.sigma_m);
    const double narrow = (1.0 - m.wide) * narrow_density(r, m, readings.max_m, m.sigma_m);
    if (!(broad + narrow > 0.0)) continue;
    const double q = broad / (broad + narrow);
    const double u = r.read_m - r.expected_m;
    const double outlier = m.share[kOutliers] * densities[i].part[kOutliers] / all;
    far_squares += outlier * u * u;
    far += outlier;
    squares += hit * u * u * ((1.0 - q) + q / (kWideHit * kWideHit));
    hits += hit;
    wide += hit * q;
  }
  if (hits > 10.0) {
    m.sigma_m = std::clamp(std::sqrt(squares / hits), 1e-3, 0.5);
    m.wide = std::clamp(wide / hits, 1e-4, 0.5);
  }
  if (far > 10.0)
    m.outlier = std::clamp(std::sqrt(far_squares / far) / m.sigma_m, kLeastOutlier, kMostOutlier);
  if (m.share[kShort] > 1e-4) m.short_rate_per_m = rate_of(readings, shortened);
}

// Derivatives of the log density by the shares and, if there are outliers, by the confounded
// parameters: the wide share and the width of outliers.
Eigen::VectorXd density_slopes(const ExpectedRange& r,
                               const RangeDensities& d,
                               const std::vector<std::size_t>& used,
                               double max_m,
                               const RangeMixture& m) {
  const bool outliers = !used.empty() && used.back() == kOutliers;
  const auto n = static_cast<Eigen::Index>(used.size());
  Eigen::VectorXd slopes(n + (outliers ? 2 : 0));
  const double all = d.of(m);
  for (Eigen::Index k = 0; k < n; ++k)
    slopes[k] = (d.part[used[static_cast<std::size_t>(k)]] - d.hit) / all;
  if (!outliers) return slopes;
  slopes[n] =
      m.hit() *
      (narrow_density(r, m, max_m, kWideHit * m.sigma_m) - narrow_density(r, m, max_m, m.sigma_m)) /
      all;
  const double u = (r.read_m - r.expected_m) / (m.outlier * m.sigma_m);
  slopes[n + 1] =
      r.read_m >= max_m - 1e-9 ? 0.0 : m.share[kOutliers] * d.part[kOutliers] * (u * u - 1.0) / all;
  return slopes;
}

// Covariance of the shares from the variation between blocks of one second.
void estimate_sigma(const RangeReadings& readings,
                    const std::vector<RangeDensities>& densities,
                    const RangeParts& parts,
                    RangeMixture& m) {
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < kRangeParts; ++k)
    if (parts[k]) used.push_back(k);
  if (used.empty()) return;
  const auto n = static_cast<Eigen::Index>(used.size() + (parts[kOutliers] ? 2 : 0));
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd block = Eigen::VectorXd::Zero(n);
  double until = -1e300;
  for (std::size_t i = 0; i < densities.size(); ++i) {
    if (readings.samples[i].t_s > until) {
      scatter += block * block.transpose();
      block.setZero();
      until = readings.samples[i].t_s + 1.0;
    }
    const Eigen::VectorXd score =
        density_slopes(readings.samples[i], densities[i], used, readings.max_m, m);
    information += score * score.transpose();
    block += score;
  }
  scatter += block * block.transpose();
  information.diagonal().array() += 1e-9;
  const Eigen::MatrixXd inverse = information.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd robust = inverse * scatter * inverse;
  for (std::size_t k = 0; k < used.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    m.sigma[used[k]] = std::sqrt(std::max(robust(at, at), inverse(at, at)));
  }
}

double log_likelihood_of(const std::vector<RangeDensities>& densities, const RangeMixture& m) {
  double sum = 0.0;
  for (const RangeDensities& d : densities) sum += std::log(d.of(m));
  return sum;
}

}  // namespace

const char* range_part_name(std::size_t part) {
  constexpr std::array<const char*, kRangeParts> kNames{"range0.short", "range0.maximum",
                                                        "range0.crosstalk", "range0.outliers"};
  return kNames[part];
}

RangeDensities range_densities(const ExpectedRange& reading,
                               const RangeMixture& mixture,
                               double max_m) {
  const BeamDensity narrow = beam_density(reading.read_m, reading.expected_m, mixture.sigma_m,
                                          mixture.short_rate_per_m, max_m);
  const double wide = narrow_density(reading, mixture, max_m, kWideHit * mixture.sigma_m);
  RangeDensities d;
  const double anything = reading.read_m >= max_m - 1e-9 ? 1.0 : 1.0 / max_m;
  d.hit = (1.0 - kFloor) * ((1.0 - mixture.wide) * narrow.hit + mixture.wide * wide) +
          kFloor * anything;
  d.part = {narrow.shortened, narrow.maximum, narrow.crosstalk,
            narrow_density(reading, mixture, max_m, mixture.outlier * mixture.sigma_m)};
  return d;
}

void fit_shares(const std::vector<RangeDensities>& densities,
                const std::vector<bool>& used,
                const RangeParts& parts,
                RangeMixture& mixture) {
  double count = 0.0;
  for (const bool u : used) count += u;
  for (std::size_t k = 0; k < kRangeParts; ++k)
    mixture.share[k] = parts[k] ? std::max(mixture.share[k], 1e-3) : 0.0;
  for (int iteration = 0; iteration < 40 && count > 0.0; ++iteration) {
    std::array<double, kRangeParts> sum{};
    for (std::size_t i = 0; i < densities.size(); ++i) {
      if (!used[i]) continue;
      const double all = densities[i].of(mixture);
      for (std::size_t k = 0; k < kRangeParts; ++k)
        sum[k] += mixture.share[k] * densities[i].part[k] / all;
    }
    for (std::size_t k = 0; k < kRangeParts; ++k) mixture.share[k] = sum[k] / count;
  }
}

RangeMixture fit_mixture(const RangeReadings& readings, const RangeParts& parts) {
  RangeMixture m;
  const std::vector<bool> all(readings.samples.size(), true);
  std::vector<RangeDensities> densities;
  // Overlapping parts (wide hits, outliers) converge slowly.
  constexpr int kMostRounds = 200;
  constexpr double kSettled = 4e-6;
  for (int round = 0; round < kMostRounds; ++round) {
    const RangeMixture before = m;
    densities = all_densities(readings, m);
    fit_shares(densities, all, parts, m);
    update_shapes(readings, densities, m);
    const bool overlap = parts[kOutliers];
    const double change =
        std::abs(m.wide - before.wide) + std::abs(m.share[kOutliers] - before.share[kOutliers]);
    if (round >= 11 && (!overlap || change < kSettled)) break;
  }
  densities = all_densities(readings, m);
  fit_shares(densities, all, parts, m);
  m.log_likelihood = log_likelihood_of(densities, m);
  estimate_sigma(readings, densities, parts, m);
  return m;
}

}  // namespace roadbook
