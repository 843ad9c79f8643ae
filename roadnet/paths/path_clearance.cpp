#include "roadnet/paths/path_clearance.hpp"

#include <algorithm>
#include <cmath>

#include "roadnet/spatial_hash.hpp"

namespace roadbook {
namespace {

constexpr double kStepShare = 1.0 / 16.0;  // of the distance looked for
constexpr int kMostSamples = 4'000'000;

struct Candidate {
  int partner = -1;
  double distance_m = 0.0;
};

// Nearest partner of every sample among those that lie far enough away along the path.
std::vector<Candidate> nearest_partners(const PathCurve& curve,
                                        const std::vector<Eigen::Vector3d>& samples,
                                        double step_m,
                                        double reach_m,
                                        double apart_m) {
  SpatialHash hash(reach_m);
  for (const auto& p : samples) hash.insert(p);
  std::vector<Candidate> nearest(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double s = step_m * static_cast<double>(i);
    hash.visit_near(samples[i], reach_m, [&](int j, double d2) {
      if (curve.distance_along(s, step_m * j) <= apart_m - step_m) return;
      Candidate& best = nearest[i];
      const double d = std::sqrt(d2);
      if (best.partner < 0 || d < best.distance_m || (d == best.distance_m && j < best.partner))
        best = {j, d};
    });
  }
  return nearest;
}

// Moves both places of a pair to where they are nearest, no nearer along the path than `apart_m`.
NearPair refine(const PathCurve& curve, double s, double other, double step_m, double apart_m) {
  const auto distance = [&](double a, double b) {
    if (curve.distance_along(a, b) < apart_m) return std::numeric_limits<double>::max();
    return (curve.at(a).position - curve.at(b).position).norm();
  };
  double best = distance(s, other);
  for (double h = step_m; h > 1e-7;) {
    double from_s = s;
    double from_other = other;
    for (const auto& [a, b] :
         {std::pair{h, 0.0}, {-h, 0.0}, {0.0, h}, {0.0, -h}, {h, -h}, {-h, h}, {h, h}, {-h, -h}}) {
      const double d = distance(from_s + a, from_other + b);
      if (d >= best) continue;
      best = d;
      s = curve.wrapped(from_s + a);
      other = curve.wrapped(from_other + b);
    }
    if (s == from_s && other == from_other) h *= 0.5;
  }
  return {s, other, best};
}

}  // namespace

NearPairs near_pairs(const PathCurve& curve, double within_m, double apart_m) {
  NearPairs result;
  const double wanted = std::max(within_m * kStepShare, curve.length_m() / kMostSamples);
  const int steps = std::max(4, static_cast<int>(std::ceil(curve.length_m() / wanted)));
  result.step_m = curve.length_m() / steps;
  std::vector<Eigen::Vector3d> samples;
  for (int i = 0; i < steps + (curve.closed() ? 0 : 1); ++i) {
    const Eigen::Vector2d p = curve.at(result.step_m * i).position;
    samples.emplace_back(p.x(), p.y(), 0.0);
  }
  // Between two samples the path comes nearer than at them by no more than half a step on each
  // side.
  const auto nearest =
      nearest_partners(curve, samples, result.step_m, within_m + result.step_m, apart_m);
  result.sample_near.resize(samples.size());
  result.sample_maybe_near.resize(samples.size());
  const auto n = static_cast<int>(samples.size());
  const auto at = [&](int i) -> const Candidate& {
    return nearest[static_cast<std::size_t>((i + n) % n)];
  };
  for (int i = 0; i < n; ++i) {
    const Candidate& here = at(i);
    if (here.partner < 0) continue;
    result.sample_maybe_near[static_cast<std::size_t>(i)] = true;
    if (here.distance_m <= within_m) result.sample_near[static_cast<std::size_t>(i)] = true;
    // Only where the neighbours have no nearer partner: the bottom of each valley, once.
    const bool first = i == 0 && !curve.closed();
    const bool last = i == n - 1 && !curve.closed();
    const bool bottom =
        (first || at(i - 1).partner < 0 || here.distance_m <= at(i - 1).distance_m) &&
        (last || at(i + 1).partner < 0 || here.distance_m < at(i + 1).distance_m);
    if (!bottom) continue;
    double other = result.step_m * here.partner;
    const double s = result.step_m * i;
    const double lack = apart_m - curve.distance_along(s, other);
    if (lack >= 0.0) other += (other > s ? 1.0 : -1.0) * (lack + 1e-9);
    const NearPair pair = refine(curve, s, curve.wrapped(other), result.step_m, apart_m);
    if (pair.distance_m > within_m) continue;
    result.worst.push_back(pair);
    result.sample_near[static_cast<std::size_t>(i)] = true;
  }
  return result;
}

}  // namespace roadbook
