#include "diagnosis/range/range_noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "diagnosis/inference/score_table.hpp"

namespace roadbook {
namespace {

using Eigen::Index;

constexpr double kRangeTests = 3.0;
constexpr double kMaxRangeNoiseP = 1e-6;  // corrected
constexpr double kBlock_s = 1.0;

struct Hit {
  std::size_t scan = 0;
  std::size_t beam = 0;
  double t_s = 0.0;
  double z = 0.0;  ///< normalised residual
  double speed = 0.0;
  double turn = 0.0;
};

// Standard deviation of a hit, wide part included.
double hit_sigma(const RangeMixture& m) {
  return m.sigma_m * std::sqrt(1.0 - m.wide + m.wide * kWideHit * kWideHit);
}

bool is_hit(const RangeReadings& readings, const ExpectedRange& r, double sigma) {
  constexpr double kFarthest = 5.0;  // [sigma] larger residuals are no hits
  return r.read_m < readings.max_m - 1e-9 && std::abs(r.read_m - r.expected_m) < kFarthest * sigma;
}

// Pose error of one scan, estimated from its hits.
struct ScanFit {
  ScanFit(std::span<const ExpectedRange> scan, const RangeReadings& readings, double sigma) {
    constexpr double kPose = 0.05;  // [m], [rad] prior; far more than errors of reference poses
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity() * (sigma * sigma / (kPose * kPose));
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const ExpectedRange& r : scan) {
      if (!is_hit(readings, r, sigma)) continue;
      ++hits;
      G += r.by_pose * r.by_pose.transpose();
      b += r.by_pose * (r.read_m - r.expected_m);
    }
    solver.compute(G);
    off = solver.solve(b);
  }
  [[nodiscard]] bool is_told() const { return hits >= 8; }

  Eigen::LDLT<Eigen::Matrix3d> solver;
  Eigen::Vector3d off;
  std::size_t hits = 0;
};

// Calls visit(number, first sample, samples) for the readings of each time, in order.
template <typename Visit>
void for_each_scan(const RangeReadings& readings, const Visit& visit) {
  const std::span<const ExpectedRange> all(readings.samples);
  std::size_t number = 0;
  for (std::size_t from = 0; from < all.size(); ++number) {
    std::size_t to = from + 1;
    while (to < all.size() && all[to].t_s == all[from].t_s) ++to;
    visit(number, from, all.subspan(from, to - from));
    from = to;
  }
}

// Residuals of the hits with the pose error of each scan projected out.
std::vector<Hit> hits_of(const RangeReadings& readings, const RangeMixture& m) {
  constexpr double kMostTaken = 0.8;
  const double sigma = hit_sigma(m);
  std::vector<Hit> hits;
  for_each_scan(readings, [&](std::size_t number, std::size_t, auto scan) {
    const ScanFit fit(scan, readings, sigma);
    if (!fit.is_told()) return;
    for (const ExpectedRange& r : scan) {
      if (!is_hit(readings, r, sigma)) continue;
      const double taken = r.by_pose.dot(fit.solver.solve(r.by_pose));
      if (taken > kMostTaken) continue;
      const double left = r.read_m - r.expected_m - r.by_pose.dot(fit.off);
      hits.push_back({number, r.beam, r.t_s, left / (sigma * std::sqrt(1.0 - taken)), r.speed,
                      std::abs(r.yaw_rate)});
    }
  });
  return hits;
}

// Sum over time blocks of the squared block sums of `values`.
double block_scatter(const std::vector<Hit>& hits, const std::vector<double>& values) {
  double squares = 0.0, block = 0.0, until = -1e300;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].t_s > until) {
      squares += block * block;
      block = 0.0;
      until = hits[i].t_s + kBlock_s;
    }
    block += values[i];
  }
  return squares + block * block;
}

NoiseCause range_noise_cause(
    const char* effect, const char* unit, double size, double sigma, double z) {
  return {effect, unit, size, sigma, z, std::min(1.0, kRangeTests * chi_squared_tail(z * z, 1))};
}

// Maximum likelihood of log variance = size * (x - mean of x).
NoiseCause range_slope(const std::vector<Hit>& hits,
                       const std::vector<double>& z,
                       double Hit::*covariate,
                       const char* effect,
                       const char* unit) {
  const auto n = static_cast<double>(hits.size());
  double mean_x = 0.0, mean_square = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    mean_x += hits[i].*covariate / n;
    mean_square += z[i] * z[i] / n;
  }
  for (const Hit& h : hits) spread += (h.*covariate - mean_x) * (h.*covariate - mean_x);
  // The covariate must vary.
  if (!(spread > 1e-4 * n)) return range_noise_cause(effect, unit, 0.0, 0.0, 0.0);
  double size = 0.0, level = std::log(mean_square);
  std::vector<double> score(hits.size());
  for (int iteration = 0; iteration < 30; ++iteration) {
    double step = 0.0, total = 0.0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const double x = hits[i].*covariate - mean_x;
      const double left = z[i] * z[i] * std::exp(-level - size * x) - 1.0;
      score[i] = left * x / spread;
      step += score[i];
      total += left / n;
    }
    size += std::clamp(0.7 * step, -1.0, 1.0);
    level += std::clamp(total, -1.0, 1.0);
  }
  const double sigma = std::sqrt(block_scatter(hits, score));
  return range_noise_cause(effect, unit, size, sigma, size / std::max(sigma, 1e-12));
}

// Speed and turn rate are correlated: the weaker is tested with the stronger in the model.
std::vector<NoiseCause> variance_causes(const std::vector<Hit>& hits) {
  std::vector<double> z;
  for (const Hit& h : hits) z.push_back(h.z);
  const auto by_speed = [&] {
    return range_slope(hits, z, &Hit::speed, "range0.variance(speed)", "s/m");
  };
  const auto by_turn = [&] {
    return range_slope(hits, z, &Hit::turn, "range0.variance(turn)", "s/rad");
  };
  const NoiseCause speed = by_speed(), turn = by_turn();
  const bool speed_first = std::abs(speed.z) >= std::abs(turn.z);
  const NoiseCause& first = speed_first ? speed : turn;
  double Hit::*covariate = speed_first ? &Hit::speed : &Hit::turn;
  for (std::size_t i = 0; i < hits.size(); ++i)
    z[i] *= std::exp(-0.5 * first.size * hits[i].*covariate);
  return {first, speed_first ? by_turn() : by_speed()};
}

// Correlation of neighbouring beams. Errors of the map are common to all beams in that direction.
double beside_correlation(const std::vector<Hit>& hits) {
  double products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i + 1 < hits.size(); ++i) {
    const Hit& a = hits[i];
    const Hit& b = hits[i + 1];
    if (a.scan != b.scan || b.beam != a.beam + 1) continue;
    products += a.z * b.z;
    squares += 0.5 * (a.z * a.z + b.z * b.z);
  }
  return squares > 0.0 ? products / squares : 0.0;
}

// Correlation of a beam with itself in the previous scan; significant only if it exceeds that of
// neighbouring beams.
NoiseCause correlation_of(const std::vector<Hit>& hits) {
  // Map errors of measured scans (an office, carmen_2d) give a correlation of 0.1 from scan to
  // scan.
  constexpr double kLeastCorrelation = 0.15;
  std::map<std::size_t, const Hit*> last;  // last hit of each beam
  std::vector<std::pair<const Hit*, const Hit*>> pairs(hits.size(), {nullptr, nullptr});
  double products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit*& before = last[hits[i].beam];
    if (before != nullptr && before->scan + 1 == hits[i].scan) {
      pairs[i] = {before, &hits[i]};
      products += before->z * hits[i].z;
      squares += 0.5 * (before->z * before->z + hits[i].z * hits[i].z);
    }
    before = &hits[i];
  }
  if (!(squares > 0.0)) return range_noise_cause("range0.correlation", "1", 0.0, 0.0, 0.0);
  const double rho = products / squares;
  std::vector<double> score(hits.size(), 0.0);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto& [a, b] = pairs[i];
    if (a != nullptr) score[i] = (a->z * b->z - 0.5 * rho * (a->z * a->z + b->z * b->z)) / squares;
  }
  const double sigma = std::sqrt(block_scatter(hits, score));
  const double beyond =
      std::abs(rho) > kLeastCorrelation ? rho - std::max(0.0, beside_correlation(hits)) : 0.0;
  return range_noise_cause("range0.correlation", "1", rho, sigma, beyond / std::max(sigma, 1e-12));
}

}  // namespace

std::vector<NoiseCause> measured_range_noise(const RangeReadings& readings,
                                             const RangeMixture& mixture) {
  constexpr std::size_t kFewestHits = 500;
  const std::vector<Hit> hits = hits_of(readings, mixture);
  if (hits.size() < kFewestHits) return {};
  std::vector<NoiseCause> causes = variance_causes(hits);
  causes.push_back(correlation_of(hits));
  return causes;
}

std::vector<NoiseCause> range_noise(const RangeReadings& readings, const RangeMixture& mixture) {
  std::vector<NoiseCause> causes = measured_range_noise(readings, mixture);
  std::erase_if(causes, [](const NoiseCause& c) { return c.p > kMaxRangeNoiseP; });
  std::stable_sort(causes.begin(), causes.end(), [](const NoiseCause& a, const NoiseCause& b) {
    return std::abs(a.z) > std::abs(b.z);
  });
  return causes;
}

Eigen::Vector3d pose_scatter(const RangeReadings& readings, const RangeMixture& mixture) {
  const double sigma = hit_sigma(mixture);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero(), own = Eigen::Vector3d::Zero();
  double scans = 0.0;
  for_each_scan(readings, [&](std::size_t, std::size_t, auto scan) {
    const ScanFit fit(scan, readings, sigma);
    if (!fit.is_told()) return;
    scans += 1.0;
    squares += fit.off.cwiseAbs2();
    own += sigma * sigma * fit.solver.solve(Eigen::Matrix3d::Identity()).diagonal();
  });
  return ((squares - own) / std::max(scans, 1.0)).cwiseMax(0.0).cwiseSqrt();
}

}  // namespace roadbook
