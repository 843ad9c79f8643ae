#include "vo/rig_pose.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <opengv/absolute_pose/CentralAbsoluteAdapter.hpp>
#include <opengv/absolute_pose/NoncentralAbsoluteAdapter.hpp>
#include <opengv/sac/Ransac.hpp>
#include <opengv/sac_problems/absolute_pose/AbsolutePoseSacProblem.hpp>

namespace roadbook {
namespace {

struct Linearised {
  Eigen::Vector2d error;          // measured - predicted [px]
  Eigen::Matrix<double, 2, 6> J;  // d predicted / d xi, T_world_vehicle * exp(xi)
};

std::optional<Linearised> linearise(const MountedCamera& mounted,
                                    const RigObservation& seen,
                                    const Eigen::Isometry3d& T_vehicle_world) {
  const Eigen::Vector3d p_vehicle = T_vehicle_world * seen.p_world;
  const Eigen::Matrix3d R_camera_vehicle = mounted.T_vehicle_camera.linear().transpose();
  const Eigen::Vector3d p_camera =
      R_camera_vehicle * (p_vehicle - mounted.T_vehicle_camera.translation());
  Matrix23d J_point;
  const auto pixel = mounted.camera.project(p_camera, &J_point);
  if (!pixel) return std::nullopt;
  Linearised result;
  result.error = seen.pixel - *pixel;
  const Matrix23d J_vehicle = J_point * R_camera_vehicle;
  result.J.leftCols<3>() = -J_vehicle;
  result.J.rightCols<3>() = J_vehicle * skew<double>(p_vehicle);
  return result;
}

void mark_inliers(const Rig& rig,
                  std::span<const RigObservation> observations,
                  const RigPoseOptions& options,
                  RigPose& pose) {
  const Eigen::Isometry3d T_vehicle_world = pose.T_world_vehicle.inverse();
  pose.inlier.assign(observations.size(), 0);
  pose.inliers = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const auto& mounted = rig.cameras[static_cast<std::size_t>(observations[i].camera)];
    const Eigen::Vector3d p_camera =
        mounted.T_vehicle_camera.inverse() * (T_vehicle_world * observations[i].p_world);
    const auto pixel = mounted.camera.project(p_camera);
    if (!pixel || !((*pixel - observations[i].pixel).norm() <= options.inlier_px)) continue;
    pose.inlier[i] = 1;
    ++pose.inliers;
  }
}

// Where the observations alone would turn, seen from the prior: `xi` from the prior to here, and
// one step of the observations' normal equations from here on.
double alone_beyond(const Matrix6d& H, const Vector6d& g, const Vector6d& xi) {
  const Eigen::LDLT<Matrix6d> ldlt(H);
  if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 1e-9)) return 0.0;
  const Vector6d step = ldlt.solve(g);
  return step.allFinite() ? xi(5) + step(5) : 0.0;
}

template <typename Adapter>
std::optional<Eigen::Isometry3d> ransac(
    Adapter& adapter,
    opengv::sac_problems::absolute_pose::AbsolutePoseSacProblem::algorithm_t algorithm,
    const RigPoseOptions& options) {
  using Problem = opengv::sac_problems::absolute_pose::AbsolutePoseSacProblem;
  opengv::sac::Ransac<Problem> sampler;
  constexpr bool kRandomSeed = false;  // the same samples every time
  sampler.sac_model_ = std::make_shared<Problem>(adapter, algorithm, kRandomSeed);
  sampler.threshold_ = 1.0 - std::cos(options.ransac_inlier_rad);
  sampler.max_iterations_ = options.ransac_iterations;
  if (!sampler.computeModel()) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = nearest_rotation(sampler.model_coefficients_.template leftCols<3>());
  T.translation() = sampler.model_coefficients_.col(3);
  if (!T.matrix().allFinite()) return std::nullopt;
  return T;
}

}  // namespace

std::optional<RigPose> refine_rig_pose(const Rig& rig,
                                       std::span<const RigObservation> observations,
                                       const Eigen::Isometry3d& initial,
                                       const std::optional<RigPosePrior>& prior,
                                       const RigPoseOptions& options) {
  RigPose pose;
  pose.T_world_vehicle = initial;
  // The robust width narrows while iterating: first far matches pull, in the end only good ones.
  double width_px = 4.0 * options.inlier_px;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    Matrix6d H = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    const Eigen::Isometry3d T_vehicle_world = pose.T_world_vehicle.inverse();
    for (const auto& seen : observations) {
      const auto& mounted = rig.cameras[static_cast<std::size_t>(seen.camera)];
      const auto linear = linearise(mounted, seen, T_vehicle_world);
      if (!linear) continue;
      const double weight = 1.0 / (options.sigma_px * options.sigma_px *
                                   (1.0 + linear->error.squaredNorm() / (width_px * width_px)));
      H.noalias() += weight * linear->J.transpose() * linear->J;
      g.noalias() += weight * linear->J.transpose() * linear->error;
    }
    if (prior) {
      const Vector6d xi = se3_log(prior->T_world_vehicle.inverse() * pose.T_world_vehicle);
      pose.heading_beyond_prior_rad = alone_beyond(H, g, xi);
      H += prior->information;
      g -= prior->information * xi;
    }
    const Eigen::LDLT<Matrix6d> ldlt(H);
    if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 1e-9)) return std::nullopt;
    const Vector6d step = ldlt.solve(g);
    if (!step.allFinite()) return std::nullopt;
    pose.T_world_vehicle = pose.T_world_vehicle * se3_exp(step);
    pose.information = H;
    width_px = std::max(options.inlier_px / 2.0, 0.6 * width_px);
    if (step.norm() < 1e-6 && iteration > 4) break;
  }
  pose.T_world_vehicle.linear() = nearest_rotation(pose.T_world_vehicle.linear());
  mark_inliers(rig, observations, options, pose);
  return pose;
}

std::optional<RigPose> find_rig_pose(const Rig& rig,
                                     std::span<const RigObservation> observations,
                                     const RigPoseOptions& options) {
  using Problem = opengv::sac_problems::absolute_pose::AbsolutePoseSacProblem;
  opengv::bearingVectors_t bearings;
  opengv::points_t points;
  std::vector<int> cameras;
  for (const auto& seen : observations) {
    const auto bearing =
        rig.cameras[static_cast<std::size_t>(seen.camera)].camera.bearing(seen.pixel);
    if (!bearing) continue;
    bearings.push_back(*bearing);
    points.push_back(seen.p_world);
    cameras.push_back(seen.camera);
  }
  if (bearings.size() < 6) return std::nullopt;
  std::optional<Eigen::Isometry3d> T;
  if (rig.cameras.size() == 1) {
    opengv::absolute_pose::CentralAbsoluteAdapter adapter(bearings, points);
    T = ransac(adapter, Problem::KNEIP, options);
    if (T) *T = *T * rig.cameras[0].T_vehicle_camera.inverse();
  } else {
    opengv::translations_t offsets;
    opengv::rotations_t rotations;
    for (const auto& mounted : rig.cameras) {
      offsets.push_back(mounted.T_vehicle_camera.translation());
      rotations.push_back(mounted.T_vehicle_camera.linear());
    }
    opengv::absolute_pose::NoncentralAbsoluteAdapter adapter(bearings, cameras, points, offsets,
                                                             rotations);
    T = ransac(adapter, Problem::GP3P, options);
  }
  if (!T) return std::nullopt;
  return refine_rig_pose(rig, observations, *T, std::nullopt, options);
}

}  // namespace roadbook
