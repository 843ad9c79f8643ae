#include "mapping/session_track.hpp"

#include <algorithm>

namespace roadbook {

SessionTrack::SessionTrack(const Map& map, int session) : map_(map) {
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    if (map.keyframes[i].session == session) {
      t_ns_.push_back(map.keyframes[i].t_ns);
      keyframes_.push_back(static_cast<int>(i));
    }
}

std::optional<Eigen::Isometry3d> SessionTrack::at(std::int64_t t_ns) const {
  constexpr double kFarthest = 3.0;  // [m] between keyframes
  const auto after = std::lower_bound(t_ns_.begin(), t_ns_.end(), t_ns);
  if (after == t_ns_.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - t_ns_.begin());
  const Eigen::Isometry3d b = map_.T_map_vehicle(keyframes_[i]);
  if (*after == t_ns) return b;
  if (i == 0 || map_.keyframes[static_cast<std::size_t>(keyframes_[i])].after_gap)
    return std::nullopt;
  const Eigen::Isometry3d a = map_.T_map_vehicle(keyframes_[i - 1]);
  if ((b.translation() - a.translation()).norm() > kFarthest) return std::nullopt;
  const double part =
      static_cast<double>(t_ns - t_ns_[i - 1]) / static_cast<double>(t_ns_[i] - t_ns_[i - 1]);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = a.translation() + part * (b.translation() - a.translation());
  T.linear() =
      Eigen::Quaterniond(a.linear()).slerp(part, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  return T;
}

}  // namespace roadbook
