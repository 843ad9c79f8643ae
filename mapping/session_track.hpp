#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/se3.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Where a session's vehicle was, from its keyframes. Refers to the map.
class SessionTrack {
 public:
  SessionTrack(const Map& map, int session);

  [[nodiscard]] const std::vector<std::int64_t>& stamps() const { return t_ns_; }
  /// Index in the map of the keyframe at `stamps()[i]`.
  [[nodiscard]] int keyframe(std::size_t i) const { return keyframes_[i]; }
  /// Pose between the keyframes before and after, if they are one movement: position by time,
  /// rotation likewise.
  [[nodiscard]] std::optional<Eigen::Isometry3d> at(std::int64_t t_ns) const;

 private:
  const Map& map_;
  std::vector<std::int64_t> t_ns_;
  std::vector<int> keyframes_;
};

/// A vehicle pose and how well it is known.
struct TrackPose {
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< right perturbation; gauge: the first keyframe fixed
};

/// Where a session's vehicle was at one stamp: at a keyframe its pose, between two as
/// `SessionTrack::at`, and less certain by what its speed may have changed between them. Just
/// behind the last keyframe (a drive ends before the next one is due) half a step further, give or
/// take half a step. Empty before the session, beyond its end and where the track is broken.
///
/// Logarithmic in the number of keyframes.
[[nodiscard]] std::optional<TrackPose> track_pose(const Map& map, int session, std::int64_t t_ns);

/// What a vehicle pose's covariance does to a point `p` of its frame: x and y of it in the map
/// [m^2].
[[nodiscard]] Eigen::Matrix2d covariance_of_point(const TrackPose& vehicle,
                                                  const Eigen::Vector3d& p);

}  // namespace roadbook
