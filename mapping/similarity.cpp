#include "mapping/similarity.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace roadbook {

Similarity align(std::span<const Eigen::Vector3d> a,
                 std::span<const Eigen::Vector3d> b,
                 bool with_scale) {
  ROADBOOK_ASSERT(a.size() == b.size());
  Similarity result;
  if (a.empty()) return result;
  const double n = static_cast<double>(a.size());
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_b = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / n;
    mean_b += b[i] / n;
  }
  Eigen::Matrix3d Sigma = Eigen::Matrix3d::Zero();  // eq. 38
  double variance_b = 0.0;                          // eq. 37
  for (std::size_t i = 0; i < a.size(); ++i) {
    Sigma += (a[i] - mean_a) * (b[i] - mean_b).transpose() / n;
    variance_b += (b[i] - mean_b).squaredNorm() / n;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(Sigma, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d d = (svd.matrixU().transpose() * Sigma * svd.matrixV()).diagonal();
  Eigen::Vector3d s = Eigen::Vector3d::Ones();  // eq. 39
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) s.z() = -1.0;
  result.R = svd.matrixU() * s.asDiagonal() * svd.matrixV().transpose();
  if (with_scale && variance_b > 0.0) result.scale = d.dot(s) / variance_b;
  result.t = mean_a - result.scale * (result.R * mean_b);
  result.unique = a.size() >= 3 && d(1) > 1e-12 * d(0) && d(0) > 0.0;
  return result;
}

TrajectoryError trajectory_error(std::span<const Eigen::Vector3d> reference,
                                 std::span<const Eigen::Vector3d> estimate,
                                 bool with_scale) {
  TrajectoryError error;
  error.T_reference_estimate = align(reference, estimate, with_scale);
  error.count = reference.size();
  if (reference.empty()) return error;
  std::vector<double> distances;
  distances.reserve(reference.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    distances.push_back((reference[i] - error.T_reference_estimate * estimate[i]).norm());
    sum += distances.back() * distances.back();
  }
  std::sort(distances.begin(), distances.end());
  const auto quantile = [&](double q) {
    const double place = q * static_cast<double>(distances.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, distances.size() - 1);
    return distances[low] + (place - static_cast<double>(low)) * (distances[high] - distances[low]);
  };
  error.median_m = quantile(0.5);
  error.p95_m = quantile(0.95);
  error.max_m = distances.back();
  error.rmse_m = std::sqrt(sum / static_cast<double>(distances.size()));
  return error;
}

std::vector<std::pair<std::size_t, std::size_t>> associate_stamps(
    std::span<const std::int64_t> a_ns,
    std::span<const std::int64_t> b_ns,
    std::int64_t tolerance_ns) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const auto gap = [&](std::size_t i, std::size_t j) { return std::abs(a_ns[i] - b_ns[j]); };
  std::size_t j = 0;
  for (std::size_t i = 0; i < a_ns.size() && !b_ns.empty(); ++i) {
    while (j + 1 < b_ns.size() && gap(i, j + 1) < gap(i, j)) ++j;
    if (gap(i, j) > tolerance_ns) continue;
    if (!pairs.empty() && pairs.back().second == j) {
      if (gap(i, j) < gap(pairs.back().first, j)) pairs.back().first = i;
      continue;
    }
    pairs.emplace_back(i, j);
  }
  return pairs;
}

}  // namespace roadbook
