#include "sensors/range/range_scores.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace roadbook {
namespace {

// Derivative of `narrow_density` by the logarithm of the noise.
double narrow_by_log_sigma(const BeamSample& r,
                           const RangeMixture& m,
                           double max_m,
                           double sigma_m) {
  if (is_maximum(r.read_m, max_m)) {
    if (is_maximum(r.expected_m, max_m)) return 0.0;
    const double u = (max_m - r.expected_m) / sigma_m;
    return u * std::exp(-0.5 * u * u) / std::sqrt(2.0 * std::numbers::pi);
  }
  const double u = (r.read_m - r.expected_m) / sigma_m;
  return narrow_density(r, m, max_m, sigma_m) * (u * u - 1.0);
}

double slope_of(std::size_t parameter,
                const BeamSample& r,
                const RangeDensities& d,
                double max_m,
                const RangeMixture& m) {
  const double broad = kWideHit * m.sigma_m;
  switch (parameter) {
    case kWideShare:
      return m.hit() *
             (narrow_density(r, m, max_m, broad) - narrow_density(r, m, max_m, m.sigma_m));
    case kOutlierWidth: {
      const double u = (r.read_m - r.expected_m) / (m.outlier * m.sigma_m);
      return is_maximum(r.read_m, max_m) ? 0.0
                                         : m.share[kOutliers] * d.part[kOutliers] * (u * u - 1.0);
    }
    case kLogSigma: {
      double slope = m.hit() * (1.0 - m.anything) * (1.0 - m.wide) *
                     narrow_by_log_sigma(r, m, max_m, m.sigma_m);
      if (m.wide > 0.0)
        slope += m.hit() * (1.0 - m.anything) * m.wide * narrow_by_log_sigma(r, m, max_m, broad);
      if (m.share[kOutliers] > 0.0)
        slope += m.share[kOutliers] * narrow_by_log_sigma(r, m, max_m, m.outlier * m.sigma_m);
      return slope;
    }
    case kLogRate: {
      const double rate = m.short_rate_per_m;
      const double x = rate * r.expected_m;
      const double cut = x > 1e-9 ? x / std::expm1(x) : 1.0;
      return m.share[kShort] * d.part[kShort] * (1.0 - rate * r.read_m - cut);
    }
    default:
      return d.part[parameter] - d.hit;
  }
}

Eigen::MatrixXd inverse_of(Eigen::MatrixXd information) {
  information.diagonal().array() += 1e-9;
  const Eigen::Index n = information.rows();
  return information.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
}

}  // namespace

Eigen::MatrixXd RangeScores::covariance() const { return inverse_of(information); }

Eigen::MatrixXd RangeScores::robust_covariance() const {
  const Eigen::MatrixXd inverse = covariance();
  return inverse * blocks * inverse;
}

RangeScores range_scores(std::span<const BeamSample> samples,
                         const std::vector<RangeDensities>& densities,
                         const std::vector<std::size_t>& which,
                         double max_m,
                         double block_s,
                         const RangeMixture& mixture) {
  const auto n = static_cast<Eigen::Index>(which.size());
  RangeScores scores{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n),
                     Eigen::MatrixXd::Zero(n, n)};
  Eigen::VectorXd block = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd score(n);
  double until = -1e300;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].t_s > until) {
      scores.blocks += block * block.transpose();
      block.setZero();
      until = samples[i].t_s + block_s;
    }
    const double all = densities[i].of(mixture);
    for (Eigen::Index k = 0; k < n; ++k)
      score[k] =
          slope_of(which[static_cast<std::size_t>(k)], samples[i], densities[i], max_m, mixture) /
          all;
    scores.gradient += score;
    scores.information += score * score.transpose();
    block += score;
  }
  scores.blocks += block * block.transpose();
  return scores;
}

}  // namespace roadbook
