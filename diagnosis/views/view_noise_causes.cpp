#include "diagnosis/views/view_noise_causes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace roadbook {
namespace {

constexpr double kMaxViewNoiseP = 0.01;
// Share of outlier views that is normal. On drives without faults, wrong matches leave up to 0.6 %
// on consistent landmarks (docs/results/diagnosis_map.md).
constexpr double kMatching = 0.01;

NoiseCause view_noise_cause(const std::string& effect,
                            const char* unit,
                            double size,
                            double sigma) {
  const double z = sigma > 0.0 ? size / sigma : 0.0;
  return {effect, unit, size, sigma, z, std::erfc(std::abs(z) / std::sqrt(2.0))};
}

// Logarithm of the mean squared residual of the views of a keyframe.
struct KeyframeSquare {
  double log_square = 0.0;
  std::size_t pose = 0;
};

std::vector<KeyframeSquare> looks(const ViewSystem& system, const Eigen::MatrixXd& sums) {
  const ViewSides sides = system.sides(sums);
  std::vector<KeyframeSquare> all;
  system.each_pose(sides, [&](std::size_t k, const ViewPanel& values) {
    const auto& info = system.row_info(k);
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < info.size(); ++i)
      if (info[i].observation >= 0) {
        const double e = values(static_cast<Eigen::Index>(i), 0);
        sum += e * e;
        count += 1.0;
      }
    if (count >= 20.0) all.push_back({std::log(sum / count + 1e-300), k});
  });
  return all;
}

// Linear regression on a covariate; the residual variance is that of the keyframes themselves.
NoiseCause variance_by(const char* name,
                       const char* unit,
                       const std::vector<KeyframeSquare>& all,
                       const std::function<double(std::size_t)>& covariate) {
  const std::string effect = std::string("cam.variance(") + name + ")";
  const auto n = static_cast<double>(all.size());
  double mx = 0.0, my = 0.0;
  for (const KeyframeSquare& l : all) {
    mx += covariate(l.pose) / n;
    my += l.log_square / n;
  }
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const KeyframeSquare& l : all) {
    const double x = covariate(l.pose) - mx;
    const double y = l.log_square - my;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  if (n < 50.0 || xx / n < 1e-4) return view_noise_cause(effect, unit, 0.0, 0.0);
  const double slope = xy / xx;
  // Neighbouring keyframes see the same landmarks: about ten of them count as one independent
  // sample.
  constexpr double kAlike = 10.0;
  return view_noise_cause(effect, unit, slope,
                          std::sqrt(kAlike * (yy - slope * xy) / (n - 2.0) / xx));
}

}  // namespace

std::vector<NoiseCause> view_noise_causes(const ViewFit& fit,
                                          const ViewSystem& system,
                                          const Eigen::MatrixXd& sums) {
  std::vector<NoiseCause> all;
  for (std::size_t c = 0; c < fit.views.size(); ++c) {
    if (fit.views[c] < 100) continue;
    const auto n = static_cast<double>(fit.views[c]);
    const double share = static_cast<double>(fit.outliers[c]) / n;
    NoiseCause outliers = view_noise_cause(fit.data.bundle.cameras[c].name + ".outliers", "1",
                                           share, std::sqrt(share * (1.0 - share) / n));
    const double chance = kMatching + 5.0 * std::sqrt(kMatching / n);
    if (share < chance) outliers.p = 1.0;
    all.push_back(outliers);
  }
  const std::vector<KeyframeSquare> every = looks(system, sums);
  const auto& moments = fit.data.moments;
  all.push_back(variance_by("speed", "s/m", every,
                            [&](std::size_t k) { return std::abs(moments[k].speed); }));
  all.push_back(variance_by("turn", "s/rad", every,
                            [&](std::size_t k) { return std::abs(moments[k].yaw_rate); }));
  std::vector<NoiseCause> named;
  for (NoiseCause& c : all) {
    c.p = std::min(1.0, c.p * static_cast<double>(all.size()));
    if (c.p < kMaxViewNoiseP) named.push_back(c);
  }
  std::stable_sort(named.begin(), named.end(), [](const NoiseCause& a, const NoiseCause& b) {
    return std::abs(a.z) > std::abs(b.z);
  });
  return named;
}

}  // namespace roadbook
