#include "mapping/cameras/track_solver.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/cameras/principal_point.hpp"

namespace roadbook {
namespace {

constexpr double kMinParallaxRad = 0.004;
constexpr double kFarM = 40.0;      // where a track without parallax starts
constexpr double kLongestM = 20.0;  // step of a point

Eigen::Isometry3d pose_of_view(const CameraView& view,
                               const KeyframeMotion& motion,
                               double late_s) {
  const auto k = static_cast<std::size_t>(view.keyframe);
  return motion.T_map_vehicle[k] * se3_exp(-late_s * motion.twist[k]);
}

}  // namespace

TrackSolver::TrackSolver(const MountedCamera& mounted,
                         const KeyframeMotion& motion,
                         const CameraErrors& errors)
    : mounted_(mounted),
      motion_(motion),
      errors_(errors),
      R_camera_vehicle_(
          (so3_exp(errors.head<3>()) * mounted.T_vehicle_camera.linear()).transpose()),
      p_vehicle_camera_(mounted.T_vehicle_camera.translation() + errors.segment<3>(6)),
      centre_(principal_point(mounted.camera)) {}

std::optional<SolvedTrack> TrackSolver::solve(const CameraTrack& track,
                                              std::optional<Eigen::Vector3d>& point) {
  const std::size_t n = std::min(track.views.size(), kMostTrackViews);
  poses_.clear();
  for (std::size_t i = 0; i < n; ++i)
    poses_.push_back(pose_of_view(track.views[i], motion_, errors_[9]));
  const int steps = point ? 2 : 4;
  if (!point) point = first_point(track, n);
  if (!point) return std::nullopt;
  SolvedTrack solved;
  for (int round = 0; round <= steps; ++round) {
    if (!evaluate(track, n, *point, solved)) {
      point.reset();
      return std::nullopt;
    }
    if (round < steps) *point += step();
  }
  eliminate(solved);
  return solved;
}

std::optional<Eigen::Vector3d> TrackSolver::bearing(const CameraView& view) const {
  const Eigen::Vector2d moved = view.pixel - centre_ - errors_.segment<2>(4);
  return mounted_.camera.bearing(centre_ + moved / (1.0 + errors_[3]));
}

std::optional<Eigen::Vector3d> TrackSolver::first_point(const CameraTrack& track, std::size_t n) {
  rays_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const auto b = bearing(track.views[i]);
    if (!b) return std::nullopt;
    rays_.push_back(
        {poses_[i] * p_vehicle_camera_, poses_[i].linear() * R_camera_vehicle_.transpose() * *b});
  }
  const auto found = triangulate(rays_, kMinParallaxRad);
  if (found) return found->p_world;
  return rays_[n / 2].origin + kFarM * rays_[n / 2].direction;
}

bool TrackSolver::evaluate(const CameraTrack& track,
                           std::size_t n,
                           const Eigen::Vector3d& p_map,
                           SolvedTrack& out) {
  A_ = 1e-9 * Eigen::Matrix3d::Identity();
  b_.setZero();
  out.count = static_cast<int>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d q = poses_[i].inverse() * p_map;
    const Eigen::Vector3d arm = q - p_vehicle_camera_;
    Matrix23d D;
    const auto ideal = mounted_.camera.project(R_camera_vehicle_ * arm, &D);
    if (!ideal) return false;
    const Eigen::Vector2d from_centre = *ideal - centre_;
    out.residual[i] =
        centre_ + errors_.segment<2>(4) + (1.0 + errors_[3]) * from_centre - track.views[i].pixel;
    const Matrix23d by_vehicle = (1.0 + errors_[3]) * D * R_camera_vehicle_;
    points_[i] = by_vehicle * poses_[i].linear().transpose();
    const Vector6d& twist = motion_.twist[static_cast<std::size_t>(track.views[i].keyframe)];
    const Eigen::Vector3d v = twist.head<3>();
    const Eigen::Vector3d w = twist.tail<3>();
    Eigen::Matrix<double, 2, 10>& J = out.columns[i];
    J.leftCols<3>() = by_vehicle * skew(arm);
    J.col(3) = from_centre;
    J.middleCols<2>(4).setIdentity();
    J.middleCols<3>(6) = -by_vehicle;
    J.col(9) = by_vehicle * (v + w.cross(q));
    A_ += points_[i].transpose() * points_[i];
    b_ += points_[i].transpose() * out.residual[i];
  }
  return true;
}

Eigen::Vector3d TrackSolver::step() const {
  Eigen::Matrix3d damped = A_;
  damped.diagonal() *= 1.0 + 1e-6;
  const Eigen::Vector3d move = -damped.ldlt().solve(b_);
  return move.norm() > kLongestM ? Eigen::Vector3d(kLongestM * move.normalized()) : move;
}

void TrackSolver::eliminate(SolvedTrack& t) const {
  Eigen::Matrix3d damped = A_;
  damped.diagonal() *= 1.0 + 1e-6;
  const Eigen::LDLT<Eigen::Matrix3d> solver(damped);
  Eigen::Matrix<double, 3, 10> C = Eigen::Matrix<double, 3, 10>::Zero();
  for (int i = 0; i < t.count; ++i)
    C += points_[static_cast<std::size_t>(i)].transpose() * t.columns[static_cast<std::size_t>(i)];
  const Eigen::Matrix<double, 3, 10> X = solver.solve(C);
  const Eigen::Vector3d x = solver.solve(b_);
  double sum = 0.0;
  for (int i = 0; i < t.count; ++i) {
    const auto s = static_cast<std::size_t>(i);
    t.columns[s] -= points_[s] * X;
    t.residual[s] -= points_[s] * x;
    sum += t.residual[s].squaredNorm();
  }
  t.rms_px = std::sqrt(sum / (2.0 * t.count - 3.0));
}

}  // namespace roadbook
