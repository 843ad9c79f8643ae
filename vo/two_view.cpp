#include "vo/two_view.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <opengv/relative_pose/CentralRelativeAdapter.hpp>
#include <opengv/sac/Ransac.hpp>
#include <opengv/sac_problems/relative_pose/CentralRelativePoseSacProblem.hpp>
#include <utility>

#include "base/se3.hpp"

namespace roadbook {

std::optional<TwoView> find_two_view(const std::vector<BearingPair>& pairs, double inlier_rad) {
  using Problem = opengv::sac_problems::relative_pose::CentralRelativePoseSacProblem;
  if (pairs.size() < 20) return std::nullopt;
  opengv::bearingVectors_t old_bearings;
  opengv::bearingVectors_t new_bearings;
  for (const auto& pair : pairs) {
    old_bearings.push_back(pair.old_bearing);
    new_bearings.push_back(pair.new_bearing);
  }
  opengv::relative_pose::CentralRelativeAdapter adapter(old_bearings, new_bearings);
  opengv::sac::Ransac<Problem> sampler;
  constexpr bool kRandomSeed = false;  // the same samples every time
  sampler.sac_model_ = std::make_shared<Problem>(adapter, Problem::NISTER, kRandomSeed);
  sampler.threshold_ = 2.0 * (1.0 - std::cos(inlier_rad));
  sampler.max_iterations_ = 500;
  if (!sampler.computeModel()) return std::nullopt;
  Problem::model_t refined = sampler.model_coefficients_;
  sampler.sac_model_->optimizeModelCoefficients(sampler.inliers_, sampler.model_coefficients_,
                                                refined);
  TwoView result;
  sampler.sac_model_->selectWithinDistance(refined, sampler.threshold_, result.inliers);
  if (!refined.allFinite() || result.inliers.size() < std::max<std::size_t>(15, pairs.size() / 3))
    return std::nullopt;
  result.T_old_new.linear() = nearest_rotation(refined.leftCols<3>());
  const Eigen::Vector3d t = refined.col(3);
  if (!(t.norm() > 1e-9)) return std::nullopt;
  result.T_old_new.translation() = t.normalized();
  return result;
}

namespace {

// Along an arc; `rise` tilts the way: a camera mounted with another pitch than its calibration
// says.
Eigen::Isometry3d arc_motion(double turn, double rise, double distance_m) {
  Eigen::Isometry3d T = pose_from_planar(distance_m * std::cos(0.5 * turn) * std::cos(rise),
                                         distance_m * std::sin(0.5 * turn) * std::cos(rise), turn);
  T.translation().z() = distance_m * std::sin(rise);
  return T;
}

struct ArcSupport {
  std::vector<int> inliers;
  int in_front = 0;  // pairs that moved as points before their camera do, less those that did not
};

// Pairs within `inlier_rad` of their epipolar plane.
ArcSupport support_of(const std::vector<BearingPair>& pairs,
                      const std::vector<Eigen::Isometry3d>& T_oldcam_newcam,
                      double inlier_rad) {
  ArcSupport support;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Isometry3d& T = T_oldcam_newcam[static_cast<std::size_t>(pairs[i].camera)];
    const Eigen::Vector3d& t = T.translation();
    const Eigen::Vector3d new_in_old = T.linear() * pairs[i].new_bearing;
    const Eigen::Vector3d normal = t.cross(pairs[i].old_bearing);
    const double length = normal.norm();
    if (length < 1e-3 * t.norm()) continue;  // at the epipole every motion fits
    if (std::abs(normal.dot(new_in_old)) > inlier_rad * length) continue;
    support.inliers.push_back(static_cast<int>(i));
    // Points move away from the epipole of the motion.
    support.in_front += normal.dot(pairs[i].old_bearing.cross(new_in_old)) > 0.0 ? 1 : -1;
  }
  return support;
}

}  // namespace

std::optional<TwoView> find_arc_motion(const std::vector<BearingPair>& pairs,
                                       const std::vector<Eigen::Isometry3d>& T_vehicle_camera,
                                       double distance_m,
                                       double inlier_rad) {
  if (pairs.size() < 20) return std::nullopt;
  constexpr double kLargestTurn = 0.3;
  constexpr double kStep = 0.002;
  constexpr double kRiseStep = 0.02;
  constexpr int kRises = 8;
  const int steps = static_cast<int>(kLargestTurn / kStep);
  TwoView best;
  std::vector<Eigen::Isometry3d> T_cameras(T_vehicle_camera.size());
  for (const double direction : {1.0, -1.0})
    for (int k = 0; k <= 2 * kRises; ++k) {
      const double rise = kRiseStep * (k % 2 == 0 ? k / 2 : -(k + 1) / 2);  // level ways first
      for (int step = -steps; step <= steps; ++step) {
        const Eigen::Isometry3d T = arc_motion(step * kStep, rise, direction * distance_m);
        for (std::size_t c = 0; c < T_cameras.size(); ++c)
          T_cameras[c] = T_vehicle_camera[c].inverse() * T * T_vehicle_camera[c];
        auto support = support_of(pairs, T_cameras, inlier_rad);
        if (support.inliers.size() <= best.inliers.size() || support.in_front <= 0) continue;
        best.T_old_new = T;
        best.inliers = std::move(support.inliers);
      }
    }
  if (best.inliers.size() < std::max<std::size_t>(15, pairs.size() / 3)) return std::nullopt;
  return best;
}

namespace {

// Sine of the angle between the new direction and the plane of the old one and the way.
double epipolar_error(const BearingPair& pair,
                      const Eigen::Isometry3d& mount,
                      const Eigen::Isometry3d& T_old_new) {
  const Eigen::Isometry3d T_new_old = (mount.inverse() * T_old_new * mount).inverse();
  const Eigen::Vector3d seen = T_new_old.linear() * pair.old_bearing;
  const Eigen::Vector3d normal = T_new_old.translation().cross(seen);
  const double length = normal.norm();
  return length > 1e-9 ? normal.dot(pair.new_bearing) / length : 0.0;
}

}  // namespace

std::optional<Eigen::Isometry3d> refine_motion(
    const std::vector<BearingPair>& pairs,
    const std::vector<Eigen::Isometry3d>& T_vehicle_camera,
    const Eigen::Isometry3d& T_old_new,
    const Matrix6d& information,
    double sigma_rad) {
  constexpr int kIterations = 6;
  constexpr double kStep = 1e-6;
  Eigen::Isometry3d T = T_old_new;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Vector6d from_prior = se3_log(T_old_new.inverse() * T);
    Matrix6d H = information;
    Vector6d g = -information * from_prior;
    std::array<Eigen::Isometry3d, 6> moved;
    for (int i = 0; i < 6; ++i)
      moved[static_cast<std::size_t>(i)] = T * se3_exp(Vector6d(kStep * Vector6d::Unit(i)));
    for (const auto& pair : pairs) {
      const auto& mount = T_vehicle_camera[static_cast<std::size_t>(pair.camera)];
      const double e = epipolar_error(pair, mount, T);
      Vector6d J;
      for (int i = 0; i < 6; ++i)
        J(i) = (epipolar_error(pair, mount, moved[static_cast<std::size_t>(i)]) - e) / kStep;
      const double weight = 1.0 / (sigma_rad * sigma_rad + e * e);
      H.noalias() += weight * J * J.transpose();
      g.noalias() -= weight * e * J;
    }
    const Eigen::LDLT<Matrix6d> ldlt(H);
    if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 0.0)) return std::nullopt;
    const Vector6d step = ldlt.solve(g);
    if (!step.allFinite()) return std::nullopt;
    T = T * se3_exp(step);
  }
  T.linear() = nearest_rotation(T.linear());
  return T;
}

}  // namespace roadbook
