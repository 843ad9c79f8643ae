#include "vo/window/window_adjustment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/se3.hpp"
#include "vo/window/driving_prior.hpp"

namespace roadbook {
namespace {

constexpr double kLeastInformation = 100.0;  // of a step [1/m^2, 1/rad^2]: what nothing holds stays
constexpr double kNotProjectedPx2 = 1e8;     // more than any view that projects

using Matrix63d = Eigen::Matrix<double, 6, 3>;

double cauchy_cost(double squared, double width) {
  return 0.5 * width * width * std::log1p(squared / (width * width));
}
double cauchy_weight(double squared, double width) {
  return 1.0 / (1.0 + squared / (width * width));
}

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// The normal equations of one point: its own block, and those with the free poses that see it.
struct PointSystem {
  Eigen::Matrix3d V = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  std::vector<std::pair<int, Matrix63d>> W;  // number of the free pose; J_pose^T J_point

  Matrix63d& with_pose(int pose) {
    for (auto& [known, block] : W)
      if (known == pose) return block;
    W.emplace_back(pose, Matrix63d::Zero());
    return W.back().second;
  }
};

class WindowSolver {
 public:
  WindowSolver(const Rig& rig, const WindowOptions& options, VoWindow& window)
      : rig_(rig),
        options_(options),
        window_(window),
        free_(static_cast<int>(window.T_odom_vehicle.size()) - window.fixed) {}

  void run() {
    if (free_ <= 0 || window_.points.empty()) return;
    double cost = total_cost();
    double damping = 1e-4;
    for (int iteration = 0; iteration < options_.iterations; ++iteration) {
      linearise();
      const auto poses = window_.T_odom_vehicle;
      const auto points = window_.points;
      const bool has_step = step(damping);
      const double new_cost = has_step ? total_cost() : cost;
      if (has_step && new_cost < cost) {
        const bool is_done = cost - new_cost < 1e-4 * cost;
        cost = new_cost;
        damping *= 0.1;
        if (is_done) return;
      } else {
        window_.T_odom_vehicle = poses;
        window_.points = points;
        damping *= 100.0;
      }
    }
  }

 private:
  [[nodiscard]] double total_cost() const {
    double cost = window_cost(rig_, window_, options_);
    for (int pose = std::max(1, window_.fixed);
         pose < static_cast<int>(window_.T_odom_vehicle.size()); ++pose) {
      const Vector6d xi = motion_of(window_, pose);
      cost += 0.5 * xi.dot(driving_information(xi.head<3>().norm()) * xi);
    }
    return cost;
  }

  static Vector6d motion_of(const VoWindow& window, int pose) {
    return se3_log(window.T_odom_vehicle[at(pose) - 1].inverse() * window.T_odom_vehicle[at(pose)]);
  }

  void linearise() {
    H_.setZero(6 * free_, 6 * free_);
    g_.setZero(6 * free_);
    systems_.assign(window_.points.size(), {});
    for (const WindowView& view : window_.views) add_view(view);
    for (int number = 0; number < free_; ++number) add_motion(number);
  }

  void add_view(const WindowView& view) {
    const MountedCamera& mounted = rig_.cameras[at(view.camera)];
    const Eigen::Isometry3d& T = window_.T_odom_vehicle[at(view.pose)];
    const Eigen::Vector3d p_vehicle = T.inverse() * window_.points[at(view.point)];
    const Eigen::Matrix3d R_camera_vehicle = mounted.T_vehicle_camera.linear().transpose();
    Matrix23d J_camera;
    const auto pixel = mounted.camera.project(
        R_camera_vehicle * (p_vehicle - mounted.T_vehicle_camera.translation()), &J_camera);
    if (!pixel) return;
    const Eigen::Vector2d error = view.pixel - *pixel;
    const Matrix23d J_vehicle = J_camera * R_camera_vehicle;
    Eigen::Matrix<double, 2, 6> J_pose;
    J_pose.leftCols<3>() = -J_vehicle;
    J_pose.rightCols<3>() = J_vehicle * skew<double>(p_vehicle);
    const Matrix23d J_point = J_vehicle * T.linear().transpose();
    const double weight = cauchy_weight(error.squaredNorm(), options_.width_px) /
                          (options_.sigma_px * options_.sigma_px);
    PointSystem& system = systems_[at(view.point)];
    system.V.noalias() += weight * J_point.transpose() * J_point;
    system.b.noalias() += weight * J_point.transpose() * error;
    const int number = view.pose - window_.fixed;
    if (number < 0) return;
    H_.block<6, 6>(6 * number, 6 * number).noalias() += weight * J_pose.transpose() * J_pose;
    g_.segment<6>(6 * number).noalias() += weight * J_pose.transpose() * error;
    system.with_pose(number).noalias() += weight * J_pose.transpose() * J_point;
  }

  // Motions within a window are small: the Jacobian of the logarithm is nearly the identity.
  void add_motion(int number) {
    const int pose = number + window_.fixed;
    const Vector6d xi = motion_of(window_, pose);
    const Matrix6d information = driving_information(xi.head<3>().norm());
    H_.block<6, 6>(6 * number, 6 * number) += information;
    g_.segment<6>(6 * number) -= information * xi;
    if (number == 0) return;
    const Matrix6d J_before = -se3_adjoint(se3_exp(-xi));
    const Matrix6d product = J_before.transpose() * information;
    const int before = 6 * (number - 1);
    H_.block<6, 6>(before, before) += product * J_before;
    H_.block<6, 6>(before, 6 * number) += product;
    H_.block<6, 6>(6 * number, before) += product.transpose();
    g_.segment<6>(before) -= product * xi;
  }

  bool step(double damping) {
    Eigen::MatrixXd S = H_;
    Eigen::VectorXd b = g_;
    S.diagonal() *= 1.0 + damping;
    S.diagonal().array() += kLeastInformation;
    std::vector<Eigen::Matrix3d> inverses(systems_.size());
    for (std::size_t i = 0; i < systems_.size(); ++i) {
      PointSystem& system = systems_[i];
      Eigen::Matrix3d V = system.V;
      V.diagonal() *= 1.0 + damping;
      V.diagonal().array() += 1e-9;
      inverses[i] = V.inverse();
      if (!inverses[i].allFinite()) return false;
      for (const auto& [row, W_row] : system.W) {
        const Matrix63d product = W_row * inverses[i];
        b.segment<6>(6 * row).noalias() -= product * system.b;
        for (const auto& [column, W_column] : system.W)
          if (column <= row)
            S.block<6, 6>(6 * row, 6 * column).noalias() -= product * W_column.transpose();
      }
    }
    const Eigen::LLT<Eigen::MatrixXd> llt(S);  // of the lower triangle
    if (llt.info() != Eigen::Success) return false;
    const Eigen::VectorXd dx = llt.solve(b);
    if (!dx.allFinite()) return false;
    for (int number = 0; number < free_; ++number) {
      Eigen::Isometry3d& T = window_.T_odom_vehicle[at(number + window_.fixed)];
      T = T * se3_exp(dx.segment<6>(6 * number));
      T.linear() = nearest_rotation(T.linear());
    }
    for (std::size_t i = 0; i < systems_.size(); ++i) {
      Eigen::Vector3d rest = systems_[i].b;
      for (const auto& [number, W] : systems_[i].W)
        rest.noalias() -= W.transpose() * dx.segment<6>(6 * number);
      window_.points[i] += inverses[i] * rest;
    }
    return true;
  }

  const Rig& rig_;
  const WindowOptions& options_;
  VoWindow& window_;
  int free_;
  Eigen::MatrixXd H_;  // of the free poses
  Eigen::VectorXd g_;
  std::vector<PointSystem> systems_;
};

}  // namespace

double window_cost(const Rig& rig, const VoWindow& window, const WindowOptions& options) {
  double cost = 0.0;
  std::vector<Eigen::Isometry3d> T_vehicle_odom;
  for (const auto& T : window.T_odom_vehicle) T_vehicle_odom.push_back(T.inverse());
  const double per_px = 1.0 / (options.sigma_px * options.sigma_px);
  for (const WindowView& view : window.views) {
    const MountedCamera& mounted = rig.cameras[at(view.camera)];
    const Eigen::Vector3d p_vehicle = T_vehicle_odom[at(view.pose)] * window.points[at(view.point)];
    const auto pixel = mounted.camera.project(mounted.T_vehicle_camera.linear().transpose() *
                                              (p_vehicle - mounted.T_vehicle_camera.translation()));
    const double squared = pixel ? (view.pixel - *pixel).squaredNorm() : kNotProjectedPx2;
    cost += per_px * cauchy_cost(squared, options.width_px);
  }
  return cost;
}

void adjust_window(const Rig& rig, const WindowOptions& options, VoWindow& window) {
  std::vector<int> views(window.T_odom_vehicle.size(), 0);
  for (const WindowView& view : window.views) ++views[at(view.pose)];
  for (std::size_t k = at(window.fixed); k < views.size(); ++k)
    if (views[k] < options.least_views) window.fixed = static_cast<int>(k) + 1;
  WindowSolver(rig, options, window).run();
}

}  // namespace roadbook
