#include "mapping/cameras/camera_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "mapping/cameras/principal_point.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {
namespace {

using Row10 = Eigen::Matrix<double, 2, 10>;

constexpr double kNoisePx = 0.5;  // of a corner, half-size image
constexpr double kMinParallaxRad = 0.004;
constexpr double kFarM = 40.0;         // where a track without parallax starts
constexpr std::size_t kMostViews = 8;  // of a track

// The camera with its errors taken away, at one view.
struct ViewGeometry {
  Eigen::Matrix3d R_camera_vehicle;
  Eigen::Vector3d p_vehicle_camera;
};

ViewGeometry corrected(const MountedCamera& mounted, const CameraErrors& e) {
  const Eigen::Matrix3d R = so3_exp(e.head<3>()) * mounted.T_vehicle_camera.linear();
  return {R.transpose(), mounted.T_vehicle_camera.translation() + e.segment<3>(6)};
}

Eigen::Isometry3d pose_of_view(const CameraView& view, const VehicleMotion& motion, double late_s) {
  const auto k = static_cast<std::size_t>(view.keyframe);
  return motion.T_map_vehicle[k] * se3_exp(-late_s * motion.twist[k]);
}

// One track with its point solved for; the point's share is taken out of residuals and columns.
struct SolvedTrack {
  int count = 0;  // views
  std::array<Eigen::Vector2d, kMostViews> residual;
  std::array<Row10, kMostViews> columns;
  double rms_px = 0.0;
};

class TrackSolver {
 public:
  TrackSolver(const MountedCamera& mounted, const VehicleMotion& motion, const CameraErrors& errors)
      : mounted_(mounted),
        motion_(motion),
        errors_(errors),
        geometry_(corrected(mounted, errors)),
        centre_(principal_point(mounted.camera)) {}

  // `point` [m, map]: where the search starts, empty for a first search; then the point found.
  std::optional<SolvedTrack> solve(const CameraTrack& track,
                                   std::optional<Eigen::Vector3d>& point) {
    const std::size_t n = std::min(track.views.size(), kMostViews);
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

 private:
  std::optional<Eigen::Vector3d> bearing(const CameraView& view) const {
    const Eigen::Vector2d moved = view.pixel - centre_ - errors_.segment<2>(4);
    return mounted_.camera.bearing(centre_ + moved / (1.0 + errors_[3]));
  }

  std::optional<Eigen::Vector3d> first_point(const CameraTrack& track, std::size_t n) {
    rays_.clear();
    for (std::size_t i = 0; i < n; ++i) {
      const auto b = bearing(track.views[i]);
      if (!b) return std::nullopt;
      rays_.push_back({poses_[i] * geometry_.p_vehicle_camera,
                       poses_[i].linear() * geometry_.R_camera_vehicle.transpose() * *b});
    }
    const auto found = triangulate(rays_, kMinParallaxRad);
    if (found) return found->p_world;
    return rays_[n / 2].origin + kFarM * rays_[n / 2].direction;
  }

  bool evaluate(const CameraTrack& track,
                std::size_t n,
                const Eigen::Vector3d& p_map,
                SolvedTrack& out) {
    A_ = 1e-9 * Eigen::Matrix3d::Identity();
    b_.setZero();
    out.count = static_cast<int>(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3d q = poses_[i].inverse() * p_map;
      const Eigen::Vector3d arm = q - geometry_.p_vehicle_camera;
      Matrix23d D;
      const auto ideal = mounted_.camera.project(geometry_.R_camera_vehicle * arm, &D);
      if (!ideal) return false;
      const Eigen::Vector2d from_centre = *ideal - centre_;
      out.residual[i] =
          centre_ + errors_.segment<2>(4) + (1.0 + errors_[3]) * from_centre - track.views[i].pixel;
      const Matrix23d by_vehicle = (1.0 + errors_[3]) * D * geometry_.R_camera_vehicle;
      points_[i] = by_vehicle * poses_[i].linear().transpose();
      const Vector6d& twist = motion_.twist[static_cast<std::size_t>(track.views[i].keyframe)];
      const Eigen::Vector3d v = twist.head<3>();
      const Eigen::Vector3d w = twist.tail<3>();
      Row10& J = out.columns[i];
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

  Eigen::Vector3d step() const {
    Eigen::Matrix3d damped = A_;
    damped.diagonal() *= 1.0 + 1e-6;
    const Eigen::Vector3d move = -damped.ldlt().solve(b_);
    const double longest = 20.0;
    return move.norm() > longest ? Eigen::Vector3d(longest * move.normalized()) : move;
  }

  void eliminate(SolvedTrack& t) const {
    Eigen::Matrix3d damped = A_;
    damped.diagonal() *= 1.0 + 1e-6;
    const Eigen::LDLT<Eigen::Matrix3d> solver(damped);
    Eigen::Matrix<double, 3, 10> C = Eigen::Matrix<double, 3, 10>::Zero();
    for (int i = 0; i < t.count; ++i)
      C +=
          points_[static_cast<std::size_t>(i)].transpose() * t.columns[static_cast<std::size_t>(i)];
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

  const MountedCamera& mounted_;
  const VehicleMotion& motion_;
  const CameraErrors& errors_;
  ViewGeometry geometry_;
  Eigen::Vector2d centre_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<Ray> rays_;
  std::array<Matrix23d, kMostViews> points_;
  Eigen::Matrix3d A_;
  Eigen::Vector3d b_;
};

// Of the tracks' errors, from a coarse first solution to the last.
constexpr std::array kWidthsPx = {3.0, 2.0, 1.0, 0.6, 0.6};

// Geman-McClure: cost and weight of a track, by its error over the width.
double robust_cost(double rms_px, double width_px) {
  const double u = rms_px * rms_px / (width_px * width_px);
  return u / (1.0 + u);
}
double robust_weight(double rms_px, double width_px) {
  const double u = rms_px * rms_px / (width_px * width_px);
  return 1.0 / ((1.0 + u) * (1.0 + u));
}

struct Normal {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
  std::map<int, Eigen::VectorXd> scores;  // by stretch
  double cost = 0.0;
};

Normal normal_equations(const MountedCamera& camera,
                        const std::vector<CameraTrack>& tracks,
                        const VehicleMotion& motion,
                        const CameraErrors& errors,
                        const ParameterRange& range,
                        double width_px,
                        std::vector<std::optional<Eigen::Vector3d>>& points) {
  Normal normal;
  normal.H = Eigen::MatrixXd::Zero(range.count, range.count);
  normal.g = Eigen::VectorXd::Zero(range.count);
  TrackSolver solver(camera, motion, errors);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const CameraTrack& track = tracks[t];
    const auto solved = solver.solve(track, points[t]);
    if (!solved) {
      normal.cost += 1.0;
      continue;
    }
    normal.cost += robust_cost(solved->rms_px, width_px);
    const double weight = robust_weight(solved->rms_px, width_px);
    Eigen::VectorXd score = Eigen::VectorXd::Zero(range.count);
    for (int i = 0; i < solved->count; ++i) {
      const auto s = static_cast<std::size_t>(i);
      const auto J = solved->columns[s].middleCols(range.first, range.count);
      normal.H.noalias() += weight * J.transpose() * J;
      score.noalias() += weight * J.transpose() * solved->residual[s];
    }
    normal.g += score;
    const auto [at, is_new] = normal.scores.try_emplace(track.stretch, score);
    if (!is_new) at->second += score;
  }
  return normal;
}

// Broad bounds of each parameter, which hold what the tracks do not determine.
CameraErrors prior_sigmas() {
  CameraErrors sigma;
  sigma << 0.3, 0.3, 0.3, 0.3, 60.0, 60.0, 0.3, 0.3, 0.3, 0.3;
  return sigma;
}

}  // namespace

ParameterRange range_of(CameraParameter parameter) {
  switch (parameter) {
    case CameraParameter::kRotation:
      return {0, 3};
    case CameraParameter::kFocal:
      return {3, 1};
    case CameraParameter::kCentre:
      return {4, 2};
    case CameraParameter::kPosition:
      return {6, 2};
    case CameraParameter::kDelay:
      return {9, 1};
  }
  return {};
}

VehicleMotion vehicle_motion(const MappingInput& input,
                             const std::vector<Eigen::Isometry3d>& T_map_vehicle) {
  VehicleMotion motion;
  motion.T_map_vehicle = T_map_vehicle;
  const auto& keyframes = input.odometry.keyframes;
  const auto joined = [&](std::size_t k) {  // with the keyframe before it
    return k > 0 && k < keyframes.size() && input.session[k] == input.session[k - 1] &&
           !keyframes[k].after_gap;
  };
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const std::size_t a = joined(k) ? k - 1 : k;
    const std::size_t b = joined(k + 1) ? k + 1 : k;
    const double seconds = static_cast<double>(keyframes[b].t_ns - keyframes[a].t_ns) * 1e-9;
    Vector6d twist = Vector6d::Zero();
    if (seconds > 0.0) twist = se3_log(T_map_vehicle[a].inverse() * T_map_vehicle[b]) / seconds;
    motion.twist.push_back(twist);
  }
  return motion;
}

double fitting_share(const MountedCamera& camera,
                     const std::vector<CameraTrack>& tracks,
                     const VehicleMotion& motion,
                     double inlier_px) {
  if (tracks.empty()) return -1.0;
  const CameraErrors none = CameraErrors::Zero();
  TrackSolver solver(camera, motion, none);
  std::size_t fit = 0;
  for (const CameraTrack& track : tracks) {
    std::optional<Eigen::Vector3d> point;
    const auto solved = solver.solve(track, point);
    fit += solved && solved->rms_px <= inlier_px ? 1 : 0;
  }
  return static_cast<double>(fit) / static_cast<double>(tracks.size());
}

double cost_as_calibrated(const MountedCamera& camera,
                          const std::vector<CameraTrack>& tracks,
                          const VehicleMotion& motion) {
  std::vector<std::optional<Eigen::Vector3d>> points(tracks.size());
  double cost = 0.0;
  for (std::size_t round = 0; round <= kWidthsPx.size(); ++round)
    cost = normal_equations(camera, tracks, motion, CameraErrors::Zero(), {0, 1}, kWidthsPx.back(),
                            points)
               .cost;
  return cost;
}

CameraFit fit_camera(const MountedCamera& camera,
                     const std::vector<CameraTrack>& tracks,
                     const VehicleMotion& motion,
                     CameraParameter parameter) {
  CameraFit fit;
  fit.parameter = parameter;
  const ParameterRange range = range_of(parameter);
  const Eigen::VectorXd prior =
      prior_sigmas().segment(range.first, range.count).array().inverse().square() * kNoisePx *
      kNoisePx;
  std::vector<std::optional<Eigen::Vector3d>> points(tracks.size());
  const auto equations = [&](double width) {
    return normal_equations(camera, tracks, motion, fit.errors, range, width, points);
  };
  for (const double width : kWidthsPx) {
    Normal normal = equations(width);
    normal.H.diagonal() += prior;
    normal.g += prior.cwiseProduct(fit.errors.segment(range.first, range.count));
    fit.errors.segment(range.first, range.count) -= normal.H.ldlt().solve(normal.g);
  }
  Normal normal = equations(kWidthsPx.back());
  normal.H.diagonal() += prior;
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(range.count, range.count);
  for (const auto& [stretch, score] : normal.scores) meat += score * score.transpose();
  const Eigen::MatrixXd inverse =
      normal.H.ldlt().solve(Eigen::MatrixXd::Identity(range.count, range.count));
  fit.sigmas.segment(range.first, range.count) =
      (inverse * meat * inverse).diagonal().cwiseMax(0.0).cwiseSqrt();
  fit.cost = normal.cost;
  return fit;
}

}  // namespace roadbook
