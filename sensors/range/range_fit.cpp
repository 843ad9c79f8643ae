#include "sensors/range/range_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "sensors/range/range_scores.hpp"

namespace roadbook {
namespace {

// Outliers have ten times the noise by definition. The scatter of hits also contains errors of map
// and pose, so their ratio to it may be smaller.
constexpr double kLeastOutlier = 6.0;
constexpr double kMostOutlier = 12.0;

using Samples = std::span<const BeamSample>;

std::vector<RangeDensities> all_densities(Samples samples, double max_m, const RangeMixture& m) {
  std::vector<RangeDensities> densities;
  densities.reserve(samples.size());
  for (const BeamSample& r : samples)
    densities.push_back(range_densities(r.read_m, r.expected_m, m, max_m));
  return densities;
}

// Maximum likelihood rate of an exponential truncated at each reading's expected distance, from
// weighted readings. Bisection in the log of the rate.
double rate_of(Samples samples, const std::vector<double>& weight) {
  const auto slope = [&](double rate) {
    double sum = 0.0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
      if (weight[i] < 1e-6) continue;
      const BeamSample& r = samples[i];
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
void update_shapes(Samples samples,
                   double max_m,
                   const std::vector<RangeDensities>& densities,
                   bool with_wide,
                   RangeMixture& m) {
  double squares = 0.0, hits = 0.0, wide = 0.0, far_squares = 0.0, far = 0.0;
  std::vector<double> shortened(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const BeamSample& r = samples[i];
    const double all = densities[i].of(m);
    // The uniform part takes readings that no hit explains; it must not affect the scale of the
    // hits.
    const double anything = is_maximum(r.read_m, max_m) ? 1.0 : 1.0 / max_m;
    const double hit = m.hit() * (densities[i].hit - m.anything * anything) / all;
    shortened[i] = m.share[kShort] * densities[i].part[kShort] / all;
    if (is_maximum(r.read_m, max_m)) continue;
    const double broad =
        with_wide ? m.wide * narrow_density(r, m, max_m, kWideHit * m.sigma_m) : 0.0;
    const double narrow = (1.0 - m.wide) * narrow_density(r, m, max_m, m.sigma_m);
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
    if (with_wide) m.wide = std::clamp(wide / hits, 1e-4, 0.5);
  }
  if (far > 10.0)
    m.outlier = std::clamp(std::sqrt(far_squares / far) / m.sigma_m, kLeastOutlier, kMostOutlier);
  if (m.share[kShort] > 1e-4) m.short_rate_per_m = rate_of(samples, shortened);
}

double log_likelihood_of(const std::vector<RangeDensities>& densities, const RangeMixture& m) {
  double sum = 0.0;
  for (const RangeDensities& d : densities) sum += std::log(d.of(m));
  return sum;
}

// Rounds of expectation maximisation, from the parameters in `m`.
void maximise(Samples samples,
              double max_m,
              const RangeFitOptions& options,
              int most_rounds,
              RangeMixture& m) {
  constexpr double kSettled = 4e-6;
  const std::vector<bool> all(samples.size(), true);
  std::vector<RangeDensities> densities;
  for (int round = 0; round < most_rounds; ++round) {
    const RangeMixture before = m;
    densities = all_densities(samples, max_m, m);
    fit_shares(densities, all, options.parts, m);
    update_shapes(samples, max_m, densities, options.wide, m);
    // Overlapping parts (wide hits, outliers) converge slowly.
    const bool overlap = options.parts[kOutliers];
    const double change =
        std::abs(m.wide - before.wide) + std::abs(m.share[kOutliers] - before.share[kOutliers]);
    if (round >= 11 && (!overlap || change < kSettled)) break;
  }
  densities = all_densities(samples, max_m, m);
  fit_shares(densities, all, options.parts, m);
  m.log_likelihood = log_likelihood_of(densities, m);
}

// Noise of a hit [m] and rate of short readings [1/m] where a fit begins.
constexpr std::array<std::array<double, 2>, 5> kStarts{
    {{0.02, 0.5}, {0.1, 0.2}, {0.005, 2.0}, {0.3, 0.5}, {0.05, 0.05}}};

RangeMixture best_start(Samples samples, double max_m, const RangeFitOptions& options) {
  constexpr int kMostRounds = 200;
  RangeMixture best;
  for (int s = 0; s < std::clamp(options.starts, 1, static_cast<int>(kStarts.size())); ++s) {
    RangeMixture m;
    m.sigma_m = kStarts[static_cast<std::size_t>(s)][0];
    m.short_rate_per_m = kStarts[static_cast<std::size_t>(s)][1];
    m.anything = options.anything;
    if (!options.wide) m.wide = 0.0;
    maximise(samples, max_m, options, kMostRounds, m);
    if (s == 0 || m.log_likelihood > best.log_likelihood) best = m;
  }
  return best;
}

std::vector<std::size_t> free_parameters(const RangeFitOptions& options, const RangeMixture& m) {
  // A share at zero has no derivative to the other side.
  constexpr double kLeastShare = 1e-6;
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < kRangeParts; ++k)
    if (options.parts[k] && m.share[k] > kLeastShare) which.push_back(k);
  if (options.wide && m.wide > 1.1e-4 && m.wide < 0.499) which.push_back(kWideShare);
  which.push_back(kLogSigma);
  if (options.parts[kShort] && m.share[kShort] > 1e-3) which.push_back(kLogRate);
  return which;
}

RangeMixture moved(const RangeMixture& m,
                   const std::vector<std::size_t>& which,
                   const Eigen::VectorXd& by) {
  RangeMixture next = m;
  for (std::size_t k = 0; k < which.size(); ++k) {
    const double step = by[static_cast<Eigen::Index>(k)];
    if (which[k] < kRangeParts) next.share[which[k]] += step;
    if (which[k] == kWideShare) next.wide += step;
    if (which[k] == kLogSigma) next.sigma_m *= std::exp(step);
    if (which[k] == kLogRate) next.short_rate_per_m *= std::exp(step);
  }
  return next;
}

bool is_possible(const RangeMixture& m) {
  double least = std::min(m.hit(), 1.0);
  for (const double share : m.share) least = std::min(least, share);
  return least >= 0.0 && m.wide >= 0.0 && m.wide < 0.5 && m.sigma_m < 0.6 &&
         m.short_rate_per_m > 0.01 && m.short_rate_per_m < 30.0;
}

// Steps of Newton's method with the empirical information (Berndt, Hall, Hall, Hausman 1974), each
// halved until the likelihood rises.
void climb(Samples samples, double max_m, const RangeFitOptions& options, RangeMixture& m) {
  constexpr int kMostSteps = 30;
  constexpr double kFlat = 1e-6;  // [nats] expected rise of a step
  for (int i = 0; i < kMostSteps; ++i) {
    const auto which = free_parameters(options, m);
    const RangeScores scores =
        range_scores(samples, all_densities(samples, max_m, m), which, max_m, options.block_s, m);
    const Eigen::VectorXd step = scores.covariance() * scores.gradient;
    if (step.dot(scores.gradient) < kFlat) return;
    bool better = false;
    for (double length = 1.0; length > 1e-3 && !better; length *= 0.5) {
      RangeMixture next = moved(m, which, length * step);
      if (!is_possible(next)) continue;
      next.log_likelihood = log_likelihood_of(all_densities(samples, max_m, next), next);
      better = next.log_likelihood > m.log_likelihood;
      if (better) m = next;
    }
    if (!better) return;
  }
}

double error_at(const Eigen::MatrixXd& robust, const Eigen::MatrixXd& plain, Eigen::Index k) {
  return std::sqrt(std::max(robust(k, k), plain(k, k)));
}

void estimate_errors(Samples samples,
                     double max_m,
                     const RangeFitOptions& options,
                     RangeMixture& m) {
  std::vector<std::size_t> which;
  if (options.to_the_maximum) {
    which = free_parameters(options, m);
  } else {
    for (std::size_t k = 0; k < kRangeParts; ++k)
      if (options.parts[k]) which.push_back(k);
    // The wide share and the width of outliers are confounded with the share of outliers.
    if (options.parts[kOutliers]) which.insert(which.end(), {kWideShare, kOutlierWidth});
  }
  if (which.empty()) return;
  const RangeScores scores =
      range_scores(samples, all_densities(samples, max_m, m), which, max_m, options.block_s, m);
  const Eigen::MatrixXd plain = scores.covariance();
  const Eigen::MatrixXd robust = scores.robust_covariance();
  Eigen::VectorXd hit = Eigen::VectorXd::Zero(plain.rows());
  for (std::size_t i = 0; i < which.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double error = error_at(robust, plain, k);
    if (which[i] < kRangeParts) {
      m.sigma[which[i]] = error;
      hit[k] = 1.0;
    }
    if (which[i] == kLogSigma) m.sigma_sigma_m = m.sigma_m * error;
    if (which[i] == kLogRate) m.sigma_rate = m.short_rate_per_m * error;
  }
  m.sigma_hit = std::sqrt(std::max(hit.dot(robust * hit), hit.dot(plain * hit)));
}

}  // namespace

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

RangeMixture fit_range_mixture(std::span<const BeamSample> samples,
                               double max_m,
                               const RangeFitOptions& options) {
  RangeMixture m = best_start(samples, max_m, options);
  if (options.to_the_maximum) climb(samples, max_m, options, m);
  estimate_errors(samples, max_m, options, m);
  return m;
}

double mean_log_density(std::span<const BeamSample> samples,
                        double max_m,
                        const RangeMixture& mixture) {
  double sum = 0.0;
  for (const BeamSample& r : samples)
    sum += std::log(range_densities(r.read_m, r.expected_m, mixture, max_m).of(mixture));
  return sum / static_cast<double>(std::max<std::size_t>(samples.size(), 1));
}

}  // namespace roadbook
