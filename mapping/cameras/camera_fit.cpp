#include "mapping/cameras/camera_fit.hpp"

#include <map>
#include <optional>

#include "mapping/cameras/track_solver.hpp"

namespace roadbook {
namespace {

constexpr double kNoisePx = 0.5;  // of a corner, half-size image

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
                        const KeyframeMotion& motion,
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

// Broad bounds of each parameter; they limit parameters that the tracks do not determine.
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

KeyframeMotion vehicle_motion(const MappingInput& input,
                              const std::vector<Eigen::Isometry3d>& T_map_vehicle) {
  KeyframeMotion motion;
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
                     const KeyframeMotion& motion,
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
                          const KeyframeMotion& motion) {
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
                     const KeyframeMotion& motion,
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
