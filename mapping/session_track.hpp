#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/se3.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// The poses of a session's vehicle over time, from its keyframes. Keeps a reference to the map.
class SessionTrack {
 public:
  SessionTrack(const Map& map, int session);

  [[nodiscard]] const std::vector<std::int64_t>& stamps() const { return t_ns_; }
  /// Index in the map of the keyframe at `stamps()[i]`.
  [[nodiscard]] int keyframe(std::size_t i) const { return keyframes_[i]; }
  /// T_map_vehicle at `t_ns`, interpolated in time between the keyframes before and after. Empty
  /// outside the session, or if the motion between these keyframes is unknown.
  [[nodiscard]] std::optional<Eigen::Isometry3d> at(std::int64_t t_ns) const;

 private:
  const Map& map_;
  std::vector<std::int64_t> t_ns_;
  std::vector<int> keyframes_;
};

/// A vehicle pose with its covariance.
struct TrackPose {
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  /// Of the right perturbation, relative to the first keyframe of its piece; NaN: unknown.
  Matrix6d covariance = unknown_covariance<Matrix6d>();
};

/// Returns the pose of a session's vehicle at one stamp. At a keyframe it is the keyframe's pose.
/// Between two keyframes it is `SessionTrack::at`, with a covariance that grows by the possible
/// change of speed between them. Just behind the last keyframe (a drive ends before the next one is
/// due) it is half a step further, with a standard deviation of half a step. Empty before the
/// session, beyond its end, and in a gap.
///
/// - At a keyframe: the pose of the keyframe.
/// - Between two keyframes: the pose of `SessionTrack::at`. The covariance interpolates those of
///   the keyframes. Along the way it adds 10 % of the step at half time, because the speed may
///   change between keyframes.
/// - After the last keyframe, because a drive may end before the next keyframe is due: the last
///   keyframe moved on by half of the last step, whatever the stamp. The standard deviation along
///   the way is half a step, and that of the rotation half of the step's turn.
///
/// The result is empty
/// - before the first keyframe of the session;
/// - over a gap, and over a step of more than 3 m between keyframes (also if it is the last step);
/// - after the session's `t_end_ns`;
/// - after the last keyframe by more than twice the time of the last step;
/// - after a keyframe that is the session's only one.
///
/// Takes time logarithmic in the number of keyframes.
[[nodiscard]] std::optional<TrackPose> track_pose(const Map& map, int session, std::int64_t t_ns);

/// Covariance [m^2] of x and y in the map of point `p` (vehicle frame [m]) that follows from the
/// covariance of the vehicle pose. NaN if that is unknown.
[[nodiscard]] Eigen::Matrix2d covariance_of_point(const TrackPose& vehicle,
                                                  const Eigen::Vector3d& p);

}  // namespace roadbook
