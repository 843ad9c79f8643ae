#include "mapping/session_track.hpp"

#include <algorithm>
#include <utility>

namespace roadbook {
namespace {

// The vehicle between two keyframes, a share `part` of the time from the first to the second.
struct Between {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  double part = 0.0;
  double apart_m = 0.0;  ///< of the keyframes
};

const Keyframe& keyframe_at(const Map& map, int index) {
  return map.keyframes[static_cast<std::size_t>(index)];
}

Eigen::Isometry3d part_of_way(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double part) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = a.translation() + part * (b.translation() - a.translation());
  T.linear() =
      Eigen::Quaterniond(a.linear()).slerp(part, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  return T;
}

// Empty where the two are not one movement.
std::optional<Between> between(const Map& map, int first, int second, std::int64_t t_ns) {
  constexpr double kFarthest = 3.0;  // [m] between keyframes
  if (keyframe_at(map, second).after_gap) return std::nullopt;
  const Eigen::Isometry3d a = map.T_map_vehicle(first);
  const Eigen::Isometry3d b = map.T_map_vehicle(second);
  Between result;
  result.apart_m = (b.translation() - a.translation()).norm();
  if (result.apart_m > kFarthest) return std::nullopt;
  const std::int64_t begin = keyframe_at(map, first).t_ns;
  result.part = static_cast<double>(t_ns - begin) /
                static_cast<double>(keyframe_at(map, second).t_ns - begin);
  result.T = part_of_way(a, b, result.part);
  return result;
}

// A keyframe's covariance as that of a pose which is fixed to it.
Matrix6d carried(const Map& map, int keyframe, const Eigen::Isometry3d& T) {
  const Matrix6d A = se3_adjoint(T.inverse() * map.T_map_vehicle(keyframe));
  return A * keyframe_at(map, keyframe).covariance * A.transpose();
}

// Along the way from one keyframe to the other.
void add_along(const Map& map, int first, int second, double sigma_m, TrackPose& pose) {
  const Eigen::Vector3d way =
      map.T_map_vehicle(second).translation() - map.T_map_vehicle(first).translation();
  if (!(way.norm() > 0.0)) return;
  const Eigen::Vector3d along = pose.T_map_vehicle.linear().transpose() * way.normalized();
  pose.covariance.topLeftCorner<3, 3>() += sigma_m * sigma_m * along * along.transpose();
}

std::optional<TrackPose> behind_last(const Map& map, int last, std::int64_t t_ns) {
  const int session = keyframe_at(map, last).session;
  if (last == 0 || keyframe_at(map, last - 1).session != session ||
      t_ns > map.sessions[static_cast<std::size_t>(session)].t_end_ns)
    return std::nullopt;
  const std::int64_t step_ns = keyframe_at(map, last).t_ns - keyframe_at(map, last - 1).t_ns;
  // Longer, and nobody knows that it is one step which was not finished.
  if (t_ns - keyframe_at(map, last).t_ns > 2 * step_ns) return std::nullopt;
  const auto step = between(map, last - 1, last, t_ns);
  if (!step) return std::nullopt;
  const Eigen::Isometry3d T_last = map.T_map_vehicle(last);
  const Eigen::Isometry3d T_step = map.T_map_vehicle(last - 1).inverse() * T_last;
  TrackPose pose;
  pose.T_map_vehicle = T_last * part_of_way(Eigen::Isometry3d::Identity(), T_step, 0.5);
  pose.covariance = carried(map, last, pose.T_map_vehicle);
  const double half_turn = 0.5 * Eigen::AngleAxisd(T_step.linear()).angle();
  pose.covariance.bottomRightCorner<3, 3>().diagonal().array() += half_turn * half_turn;
  add_along(map, last - 1, last, 0.5 * step->apart_m, pose);
  return pose;
}

}  // namespace

SessionTrack::SessionTrack(const Map& map, int session) : map_(map) {
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    if (map.keyframes[i].session == session) {
      t_ns_.push_back(map.keyframes[i].t_ns);
      keyframes_.push_back(static_cast<int>(i));
    }
}

std::optional<Eigen::Isometry3d> SessionTrack::at(std::int64_t t_ns) const {
  const auto after = std::lower_bound(t_ns_.begin(), t_ns_.end(), t_ns);
  if (after == t_ns_.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - t_ns_.begin());
  if (*after == t_ns) return map_.T_map_vehicle(keyframes_[i]);
  if (i == 0) return std::nullopt;
  const auto found = between(map_, keyframes_[i - 1], keyframes_[i], t_ns);
  if (!found) return std::nullopt;
  return found->T;
}

std::optional<TrackPose> track_pose(const Map& map, int session, std::int64_t t_ns) {
  const auto before = [](const Keyframe& k, const std::pair<int, std::int64_t>& stamp) {
    return std::pair(k.session, k.t_ns) < stamp;
  };
  const auto& all = map.keyframes;
  const auto found = std::lower_bound(all.begin(), all.end(), std::pair(session, t_ns), before);
  const int next = static_cast<int>(found - all.begin());
  const bool any_next = found != all.end() && found->session == session;
  if (any_next && found->t_ns == t_ns) return TrackPose{map.T_map_vehicle(next), found->covariance};
  if (next == 0 || keyframe_at(map, next - 1).session != session) return std::nullopt;
  if (!any_next) return behind_last(map, next - 1, t_ns);
  const auto way = between(map, next - 1, next, t_ns);
  if (!way) return std::nullopt;
  TrackPose pose{way->T, Matrix6d::Zero()};
  // Errors of neighbours go together in a way that is not kept: this holds whichever it is.
  pose.covariance =
      (1.0 - way->part) * carried(map, next - 1, way->T) + way->part * carried(map, next, way->T);
  // Half way a car is a tenth of the way off when its speed changes by 80 % from one to the other.
  constexpr double kUneven = 0.1;
  const double sigma_m = kUneven * 4.0 * way->part * (1.0 - way->part) * way->apart_m;
  add_along(map, next - 1, next, sigma_m, pose);
  return pose;
}

Eigen::Matrix2d covariance_of_point(const TrackPose& vehicle, const Eigen::Vector3d& p) {
  // p_map = T exp(xi) p, so that dp = R (xi_t + xi_r x p).
  const Eigen::Matrix3d R = vehicle.T_map_vehicle.linear();
  Eigen::Matrix<double, 3, 6> J;
  J.leftCols<3>() = R;
  J.rightCols<3>() = -R * skew(p);
  const Eigen::Matrix3d full = J * vehicle.covariance * J.transpose();
  return full.topLeftCorner<2, 2>();
}

}  // namespace roadbook
