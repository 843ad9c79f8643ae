#include "mapping/localisation/landmark_pose.hpp"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include "base/index.hpp"
#include "mapping/optimisation/ceres_solve.hpp"

namespace roadbook {
namespace {

constexpr double kNotSeen = 50.0;  // residual of a point that the camera model cannot see [sigma]

// The unknowns are a step (translation [m], rotation vector [rad]) from the initial pose:
// T_map_vehicle = T_initial * (step).
using Step = std::array<double, 6>;

Eigen::Isometry3d transform_of(const Step& step) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = so3_exp({step[3], step[4], step[5]});
  T.translation() = Eigen::Vector3d(step[0], step[1], step[2]);
  return T;
}

// d xi / d step, where T_initial * step * exp(xi) moves the pose by a change of the step.
Matrix6d perturbation_of_step(const Step& step) {
  const Eigen::Vector3d turn(step[3], step[4], step[5]);
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = so3_exp(turn).transpose();
  J.bottomRightCorner<3, 3>() = so3_right_jacobian(turn);
  return J;
}

// Error of a pixel. The step moves the vehicle: p_vehicle = R^T (p_initial - t), with the rotation
// R of the rotation vector.
class PixelCost final : public ceres::SizedCostFunction<2, 6> {
 public:
  // `p_initial`: landmark in the vehicle frame of the initial pose. `root`: of the information of
  // the error.
  PixelCost(const MountedCamera& mounted,
            Eigen::Vector3d p_initial,
            Eigen::Vector2d pixel,
            Eigen::Matrix2d root)
      : mounted_(mounted),
        p_initial_(std::move(p_initial)),
        pixel_(std::move(pixel)),
        root_(std::move(root)) {
    mounted_.camera.max_angle_rad = std::numbers::pi;  // a step may pass the angle of the lens
  }

  bool Evaluate(const double* const* parameters,
                double* residual,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> way(parameters[0]);
    const Eigen::Map<const Eigen::Vector3d> turn(parameters[0] + 3);
    const Eigen::Vector3d p_vehicle = so3_exp(-turn) * (p_initial_ - way);
    const Eigen::Matrix3d R_camera_vehicle = mounted_.T_vehicle_camera.linear().transpose();
    const Eigen::Vector3d p_camera =
        R_camera_vehicle * (p_vehicle - mounted_.T_vehicle_camera.translation());
    Eigen::Map<Eigen::Vector2d> e(residual);
    const bool wants_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
    Matrix23d J_point;
    const auto predicted = mounted_.camera.project(p_camera, wants_jacobian ? &J_point : nullptr);
    e = predicted ? Eigen::Vector2d(root_ * (pixel_ - *predicted)) : Eigen::Vector2d(kNotSeen, 0.0);
    if (!wants_jacobian) return true;
    Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>> J(jacobians[0]);
    J.setZero();
    if (!predicted) return true;
    const Matrix23d J_vehicle = -root_ * J_point * R_camera_vehicle;
    J.leftCols<3>() = -J_vehicle * so3_exp(-turn);
    J.rightCols<3>() = J_vehicle * skew(p_vehicle) * so3_right_jacobian(turn);
    return true;
  }

 private:
  MountedCamera mounted_;
  Eigen::Vector3d p_initial_;
  Eigen::Vector2d pixel_;
  Eigen::Matrix2d root_;
};

class PriorCost final : public ceres::SizedCostFunction<6, 6> {
 public:
  PriorCost(const Step& expected, Matrix6d root) : expected_(expected), root_(std::move(root)) {}

  bool Evaluate(const double* const* parameters,
                double* residual,
                double** jacobians) const override {
    const Vector6d off =
        Eigen::Map<const Vector6d>(parameters[0]) - Eigen::Map<const Vector6d>(expected_.data());
    Eigen::Map<Vector6d> e(residual);
    e = root_ * off;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> J(jacobians[0]);
    J = root_;
    return true;
  }

 private:
  Step expected_;
  Matrix6d root_;
};

// Matrix A with A^T A = the inverse of the covariance of the error, at the initial pose.
std::optional<Eigen::Matrix2d> information_root(const MountedCamera& mounted,
                                                const LandmarkPixel& seen,
                                                const Eigen::Isometry3d& T_camera_map,
                                                double sigma_px) {
  Matrix23d J_point;
  if (!mounted.camera.project(T_camera_map * seen.p_map, &J_point)) return std::nullopt;
  const Matrix23d J = J_point * T_camera_map.linear();
  Eigen::Matrix2d S = J * seen.covariance * J.transpose();
  S.diagonal().array() += sigma_px * sigma_px;
  const Eigen::Matrix2d information = S.inverse();
  return Eigen::Matrix2d(information.llt().matrixU());
}

struct Terms {
  std::vector<std::unique_ptr<ceres::CostFunction>> costs;
  std::vector<std::size_t> pixel;  // of each cost
};

struct Group {
  Vector6d g = Vector6d::Zero();
  Matrix6d H = Matrix6d::Zero();
};

// The group of a landmark: its camera and the eighth of the horizon around the vehicle.
std::pair<int, int> group_of(const LandmarkPixel& seen, const Eigen::Isometry3d& T_vehicle_map) {
  const Eigen::Vector3d p = T_vehicle_map * seen.p_map;
  const double eighths = (std::atan2(p.y(), p.x()) / std::numbers::pi + 1.0) * 4.0;
  return {seen.camera, std::min(7, static_cast<int>(eighths))};
}

// Errors, inliers and normal equations at the final pose.
void judge(const Terms& terms,
           std::span<const LandmarkPixel> pixels,
           const Step& step,
           const LandmarkPoseOptions& options,
           LandmarkPose& pose) {
  const double gate = options.inlier_sigma * options.inlier_sigma;
  const double width = options.loss_sigma * options.loss_sigma;
  const double* parameters = step.data();
  const Matrix6d step_of_xi = perturbation_of_step(step).inverse();
  const Eigen::Isometry3d T_vehicle_map = pose.T_map_vehicle.inverse();
  std::map<std::pair<int, int>, Group> groups;
  for (std::size_t i = 0; i < terms.costs.size(); ++i) {
    Eigen::Vector2d e;
    Eigen::Matrix<double, 2, 6, Eigen::RowMajor> J;
    double* jacobian = J.data();
    terms.costs[i]->Evaluate(&parameters, e.data(), &jacobian);
    const double chi2 = e.squaredNorm();
    const double weight = 1.0 / (1.0 + chi2 / width);
    const Eigen::Matrix<double, 2, 6> J_xi = J * step_of_xi;
    Group& group = groups[group_of(pixels[terms.pixel[i]], T_vehicle_map)];
    group.H.noalias() += weight * J_xi.transpose() * J_xi;
    group.g.noalias() += weight * J_xi.transpose() * e;
    if (chi2 > gate) continue;
    pose.inlier[terms.pixel[i]] = 1;
    pose.chi2 += chi2;
    ++pose.inliers;
  }
  for (const auto& [key, group] : groups) pose.information += group.H;
  const CauchyMoments moments = cauchy_moments(options.loss_sigma);
  const Matrix6d inverse =
      (pose.information + 1e-9 * Matrix6d::Identity()).ldlt().solve(Matrix6d::Identity());
  for (const auto& [key, group] : groups) {
    const Matrix6d share = group.H * inverse;
    pose.pull_found += group.g.dot(inverse * group.g);
    pose.pull_expected += moments.squared_pull * (share.trace() - (share * share).trace());
  }
  // Covariance of the minimum of a robust cost: A^-1 B A^-1 with the Hessian A and B = E(g g^T)
  // (Huber 1967), both multiples of the information that the weights give.
  pose.information *= moments.hessian * moments.hessian / moments.squared_pull;
}

}  // namespace

CauchyMoments cauchy_moments(double width_sigma) {
  // s = e^T e is distributed as exp(-s / 2) / 2. Midpoints up to where nothing is left.
  constexpr int kSteps = 4000;
  constexpr double kLargest = 60.0;
  const double width2 = width_sigma * width_sigma;
  double w_mean = 0.0;
  double pull = 0.0;
  double curve = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double step = kLargest / kSteps;
    const double s = (i + 0.5) * step;
    const double share = 0.5 * std::exp(-0.5 * s) * step;
    const double w = 1.0 / (1.0 + s / width2);
    w_mean += share * w;
    pull += share * w * w * 0.5 * s;
    curve += share * w * w * s / width2;  // the mean over directions of -2 rho'' e e^T
  }
  return {pull / w_mean, (w_mean - curve) / w_mean};
}

std::optional<LandmarkPose> solve_landmark_pose(const Rig& rig,
                                                std::span<const LandmarkPixel> pixels,
                                                const Eigen::Isometry3d& initial,
                                                const std::optional<RigPosePrior>& prior,
                                                const LandmarkPoseOptions& options) {
  Step step{};
  ceres::CauchyLoss loss(options.loss_sigma);
  auto problem_options = ceres_problem_options();
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.disable_all_safety_checks = true;  // they cost more than the small problem
  ceres::Problem problem(problem_options);
  problem.AddParameterBlock(step.data(), 6);
  Terms terms;
  const Eigen::Isometry3d T_vehicle_map = initial.inverse();
  std::vector<Eigen::Isometry3d> T_camera_map;
  for (const MountedCamera& mounted : rig.cameras)
    T_camera_map.push_back(mounted.T_vehicle_camera.inverse() * T_vehicle_map);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const MountedCamera& mounted = rig.cameras[at(pixels[i].camera)];
    const auto root =
        information_root(mounted, pixels[i], T_camera_map[at(pixels[i].camera)], options.sigma_px);
    if (!root) continue;
    terms.costs.push_back(std::make_unique<PixelCost>(mounted, T_vehicle_map * pixels[i].p_map,
                                                      pixels[i].pixel, *root));
    terms.pixel.push_back(i);
    problem.AddResidualBlock(terms.costs.back().get(), &loss, step.data());
  }
  if (terms.costs.size() < 3) return std::nullopt;
  std::unique_ptr<ceres::CostFunction> prior_cost;
  if (prior) {
    const Eigen::Isometry3d T_initial_prior = T_vehicle_map * prior->T_world_vehicle;
    const Eigen::Vector3d turn = so3_log(T_initial_prior.linear());
    const Eigen::Vector3d& way = T_initial_prior.translation();
    const Step expected{way.x(), way.y(), way.z(), turn.x(), turn.y(), turn.z()};
    prior_cost = std::make_unique<PriorCost>(
        expected, prior->information.llt().matrixU() * perturbation_of_step(expected));
    problem.AddResidualBlock(prior_cost.get(), nullptr, step.data());
  }
  const auto outcome = solve_by_ceres(
      ceres_solver_options(ceres::DENSE_NORMAL_CHOLESKY, options.max_iterations, 1e8),
      options.relative_tolerance, {}, problem);
  static_cast<void>(outcome);  // a pose that has not converged is judged by its inliers
  LandmarkPose pose;
  pose.T_map_vehicle = initial * transform_of(step);
  pose.T_map_vehicle.linear() = nearest_rotation(pose.T_map_vehicle.linear());
  pose.inlier.assign(pixels.size(), 0);
  if (!pose.T_map_vehicle.matrix().allFinite()) return std::nullopt;
  judge(terms, pixels, step, options, pose);
  return pose;
}

}  // namespace roadbook
