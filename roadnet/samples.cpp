#include "roadnet/samples.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "roadnet/spatial_hash.hpp"

namespace roadbook {
namespace {

constexpr double kStep_m = 0.5;
constexpr double kLateralLimit_m = 2.5;  // farther apart is another lane
constexpr double kOtherVisit_m = 15.0;   // travelled since: another visit to the place
constexpr double kSameHeading = 0.97;    // cosine

struct Directed {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;
  std::size_t pass;
  double along_m;
};

std::vector<Directed> directed_samples(const std::vector<DrivenPass>& passes) {
  std::vector<Directed> all;
  for (std::size_t p = 0; p < passes.size(); ++p) {
    const auto points = resample(passes[p], kStep_m).points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Eigen::Vector3d direction = (points[i + 1] - points[i]).normalized();
      all.push_back({points[i], direction, p, static_cast<double>(i) * kStep_m});
    }
  }
  return all;
}

}  // namespace

void check_passes(const std::vector<DrivenPass>& passes) {
  std::vector<Problem> problems;
  for (std::size_t p = 0; p < passes.size(); ++p) {
    for (std::size_t i = 0; i < passes[p].positions.size(); ++i) {
      const Eigen::Vector3d& at = passes[p].positions[i];
      // Beyond a million kilometres a step of a metre is lost in rounding.
      if (at.allFinite() && at.cwiseAbs().maxCoeff() < 1e9) continue;
      problems.push_back(
          {.severity = Severity::kError,
           .file = "driven passes",
           .line = 0,
           .field = "passes[" + std::to_string(p) + "].positions[" + std::to_string(i) + "]",
           .got =
               std::to_string(at.x()) + " " + std::to_string(at.y()) + " " + std::to_string(at.z()),
           .want = "three finite numbers below 1e9 m"});
    }
  }
  if (!problems.empty()) throw BadInput(std::move(problems));
}

PassSamples resample(const DrivenPass& pass, double step_m, double z_scale) {
  PassSamples samples;
  if (pass.positions.empty()) return samples;
  const Eigen::Vector3d scale(1.0, 1.0, z_scale);
  Eigen::Vector3d last = pass.positions.front().cwiseProduct(scale);
  samples.points.push_back(last);
  for (const Eigen::Vector3d& position : pass.positions) {
    const Eigen::Vector3d target = position.cwiseProduct(scale);
    // From the last sample, not along every wiggle: jitter at a standstill adds no distance.
    double distance = (target - last).norm();
    while (distance >= step_m) {
      last += (target - last) * (step_m / distance);
      samples.points.push_back(last);
      distance = (target - last).norm();
    }
  }
  const Eigen::Vector3d end = pass.positions.back().cwiseProduct(scale);
  if (samples.points.size() > 1 && (end - last).norm() > 0.0) samples.points.push_back(end);
  return samples;
}

double lateral_scatter(const std::vector<DrivenPass>& passes) {
  const std::vector<Directed> all = directed_samples(passes);
  SpatialHash hash(kLateralLimit_m);
  for (const Directed& sample : all) hash.insert(sample.point);

  std::vector<double> offsets;
  const std::size_t stride = all.size() / 4000 + 1;
  for (std::size_t i = 0; i < all.size(); i += stride) {
    const Directed& a = all[i];
    hash.visit_near(a.point, kLateralLimit_m, [&](int index, double) {
      const Directed& b = all[static_cast<std::size_t>(index)];
      if (a.pass == b.pass && std::abs(a.along_m - b.along_m) < kOtherVisit_m) return;
      const Eigen::Vector3d d = b.point - a.point;
      if (a.direction.dot(b.direction) < kSameHeading) return;
      if (std::abs(a.direction.dot(d)) > 0.5 * kStep_m) return;
      offsets.push_back(std::abs(a.direction.x() * d.y() - a.direction.y() * d.x()));
    });
  }
  if (offsets.empty()) return 0.0;
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  // Median of |N(0, 2 sigma^2)| is 0.6745 sqrt(2) sigma.
  return *middle / (0.6745 * std::sqrt(2.0));
}

}  // namespace roadbook
