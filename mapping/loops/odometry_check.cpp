#include "mapping/loops/odometry_check.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace roadbook {
namespace {

constexpr double kLargestChi2 = 11.345;  // 3 degrees of freedom, p = 0.01
// Standard deviation of height, roll and pitch over a long way, relative to the discounted one of
// the motions. Heights are wrong by 0.65 m at most after 140 to 190 m in garages; the discounted
// information would allow 2 to 3 m (docs/results/robustness.md).
constexpr double kOutOfPlaneShare = 0.2;

// Covariances of the odometry's poses relative to the first keyframe, as left perturbations.
std::vector<Matrix6d> covariances_of_way(const std::vector<VoKeyframe>& keyframes) {
  Vector6d share = Vector6d::Ones();
  share.segment<3>(2).setConstant(kOutOfPlaneShare);
  std::vector<Matrix6d> sums(keyframes.size(), Matrix6d::Zero());
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    sums[k] = sums[k - 1];
    if (keyframes[k].after_gap) continue;
    const Matrix6d inverse = keyframes[k].information.ldlt().solve(Matrix6d::Identity());
    const Matrix6d J = se3_adjoint(keyframes[k].T_odom_vehicle) * share.asDiagonal();
    sums[k] += J * inverse * J.transpose();
  }
  return sums;
}

// Squared Mahalanobis distance of the loop from the odometry in height, roll and pitch.
double out_of_plane_chi2(const LoopEdge& edge,
                         const std::vector<VoKeyframe>& keyframes,
                         const std::vector<Matrix6d>& way) {
  const auto from = static_cast<std::size_t>(edge.from);
  const auto to = static_cast<std::size_t>(edge.to);
  const Eigen::Isometry3d T_to_odom = keyframes[to].T_odom_vehicle.inverse();
  const Eigen::Isometry3d error =
      edge.T_from_to.inverse() * keyframes[from].T_odom_vehicle.inverse() * T_to_odom.inverse();
  Vector6d r;
  r << error.translation(), so3_log(error.linear());
  const Matrix6d J = se3_adjoint(T_to_odom);
  const Matrix6d covariance = J * (way[to] - way[from]) * J.transpose() +
                              edge.information.ldlt().solve(Matrix6d::Identity());
  const Eigen::Vector3d out = r.segment<3>(2);
  const Eigen::Matrix3d block = covariance.block<3, 3>(2, 2);
  const double chi2 = out.dot(block.ldlt().solve(out));
  return std::isfinite(chi2) ? chi2 : 0.0;
}

}  // namespace

std::vector<std::uint8_t> contradict_odometry(const std::vector<VoKeyframe>& keyframes,
                                              const std::vector<LoopEdge>& edges,
                                              const std::vector<int>& stretch) {
  const auto way = covariances_of_way(keyframes);
  std::vector<int> gaps_before(keyframes.size(), 0);
  for (std::size_t k = 1; k < keyframes.size(); ++k)
    gaps_before[k] = gaps_before[k - 1] + (keyframes[k].after_gap ? 1 : 0);
  const auto is_judged = [&](const LoopEdge& edge) {
    return gaps_before[static_cast<std::size_t>(edge.from)] ==
           gaps_before[static_cast<std::size_t>(edge.to)];
  };
  std::map<int, std::vector<double>> chi2_of_stretch;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (is_judged(edges[i]))
      chi2_of_stretch[stretch[i]].push_back(out_of_plane_chi2(edges[i], keyframes, way));
  std::map<int, double> median_of_stretch;
  for (auto& [number, chi2] : chi2_of_stretch) {
    const auto middle = chi2.begin() + static_cast<std::ptrdiff_t>(chi2.size() / 2);
    std::nth_element(chi2.begin(), middle, chi2.end());
    median_of_stretch[number] = *middle;
  }
  std::vector<std::uint8_t> contradicts(edges.size(), 0);
  for (std::size_t i = 0; i < edges.size(); ++i)
    contradicts[i] = is_judged(edges[i]) && median_of_stretch[stretch[i]] > kLargestChi2 ? 1 : 0;
  return contradicts;
}

}  // namespace roadbook
