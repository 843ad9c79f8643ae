#include "vo/exposure_shift.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "base/index.hpp"

namespace roadbook {
namespace {

double seconds(const VoKeyframe& from, const VoKeyframe& to) {
  return 1e-9 * static_cast<double>(to.t_ns - from.t_ns);
}

// Mean twist between two successive keyframes, in the frame of either; empty across a gap.
std::optional<Vector6d> twist_between(const VoKeyframe& from, const VoKeyframe& to) {
  const double dt = seconds(from, to);
  if (to.after_gap || !(dt > 0.0)) return std::nullopt;
  return se3_log(from.T_odom_vehicle.inverse() * to.T_odom_vehicle) / dt;
}

// Twists of the car at the keyframes [m/s, rad/s]; zero for a keyframe between two gaps.
std::vector<Vector6d> twists_at(const std::vector<VoKeyframe>& keyframes) {
  std::vector<Vector6d> twists(keyframes.size(), Vector6d::Zero());
  std::optional<Vector6d> before;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    std::optional<Vector6d> after;
    if (k + 1 < keyframes.size()) after = twist_between(keyframes[k], keyframes[k + 1]);
    if (before && after) {
      // Each mean holds for the middle of its interval; between the middles the twist is linear.
      const double to_before = seconds(keyframes[k - 1], keyframes[k]);
      const double to_after = seconds(keyframes[k], keyframes[k + 1]);
      twists[k] = (to_after * *before + to_before * *after) / (to_before + to_after);
    } else if (before || after) {
      twists[k] = before ? *before : *after;
    }
    before = after;
  }
  return twists;
}

// Exposure time of a row less the stamp of the instant [s].
double after_stamp_s(const MountedCamera& mounted, double row) {
  const double share = (row + 0.5) / mounted.camera.height - 0.5;
  return mounted.exposed_after_s + mounted.rolling_shutter_s * share;
}

// From the vehicle at the stamp to the vehicle when the row was exposed.
Eigen::Isometry3d moved_on(const MountedCamera& mounted, double row, const Vector6d& twist) {
  return se3_exp(twist * after_stamp_s(mounted, row));
}

// Moves the places of tracks by the way between stamp and exposure in the middle of each track.
void move_places(const Rig& rig, const std::vector<Vector6d>& twists, VoResult& odometry) {
  for (Track& track : odometry.tracks) {
    if (!track.p_odom) continue;
    const TrackObservation& seen = track.observations[track.observations.size() / 2];
    const VoKeyframe& keyframe = odometry.keyframes[at(seen.keyframe)];
    const double row =
        keyframe.features[at(track.camera)].pixels[at(seen.feature)].cast<double>().y();
    const Eigen::Isometry3d T =
        moved_on(rig.cameras[at(track.camera)], row, twists[at(seen.keyframe)]);
    track.p_odom =
        keyframe.T_odom_vehicle * (T * (keyframe.T_odom_vehicle.inverse() * *track.p_odom));
  }
}

// A corner of an image, and the point that it shows (vehicle frame) if its track has a place.
struct ShownCorner {
  Eigen::Vector2d pixel;
  std::optional<Eigen::Vector3d> p_vehicle;
};

// Gives corners without a place the distance from the camera of the nearest corner that has one.
// Nearly half of all corners have none, and many of them lie on the ground nearby.
void guess_places(const MountedCamera& mounted, std::vector<ShownCorner>& corners) {
  std::vector<std::pair<Eigen::Vector2d, double>> ranges;
  const Eigen::Vector3d centre = mounted.T_vehicle_camera.translation();
  for (const ShownCorner& corner : corners)
    if (corner.p_vehicle) ranges.push_back({corner.pixel, (*corner.p_vehicle - centre).norm()});
  for (ShownCorner& corner : corners) {
    if (corner.p_vehicle) continue;
    const auto ray = mounted.camera.bearing(corner.pixel);
    if (!ray) continue;
    const auto nearest =
        std::min_element(ranges.begin(), ranges.end(), [&](const auto& one, const auto& other) {
          return (one.first - corner.pixel).squaredNorm() <
                 (other.first - corner.pixel).squaredNorm();
        });
    constexpr double kFarM = 1e4;
    const double range = nearest == ranges.end() ? kFarM : nearest->second;
    corner.p_vehicle = mounted.T_vehicle_camera * (range * *ray);
  }
}

// How far a corner moves [px]; nothing where one of its projections is not seen.
Eigen::Vector2d shift_of(const MountedCamera& mounted,
                         const Eigen::Isometry3d& T_stamp_exposed,
                         const ShownCorner& corner) {
  if (!corner.p_vehicle) return Eigen::Vector2d::Zero();
  const Eigen::Isometry3d T_camera_vehicle = mounted.T_vehicle_camera.inverse();
  const auto seen =
      mounted.camera.project(T_camera_vehicle * (T_stamp_exposed.inverse() * *corner.p_vehicle));
  const auto at_stamp = mounted.camera.project(T_camera_vehicle * *corner.p_vehicle);
  if (!seen || !at_stamp || !mounted.camera.contains(corner.pixel + *at_stamp - *seen))
    return Eigen::Vector2d::Zero();
  return *at_stamp - *seen;
}

}  // namespace

bool exposes_beside_stamp(const Rig& rig) {
  return std::any_of(rig.cameras.begin(), rig.cameras.end(), [](const MountedCamera& camera) {
    return camera.exposed_after_s != 0.0 || camera.rolling_shutter_s != 0.0;
  });
}

Rig rig_at_exposure(const Rig& rig, const Vector6d& twist) {
  Rig moved = rig;
  for (MountedCamera& camera : moved.cameras)
    camera.T_vehicle_camera = se3_exp(twist * camera.exposed_after_s) * camera.T_vehicle_camera;
  return moved;
}

void move_to_stamps(const Rig& half_rig, VoResult& odometry) {
  if (!exposes_beside_stamp(half_rig)) return;
  const std::vector<Vector6d> twists = twists_at(odometry.keyframes);
  move_places(half_rig, twists, odometry);
  for (std::size_t k = 0; k < odometry.keyframes.size(); ++k) {
    VoKeyframe& keyframe = odometry.keyframes[k];
    const Eigen::Isometry3d T_vehicle_odom = keyframe.T_odom_vehicle.inverse();
    for (std::size_t c = 0; c < keyframe.features.size(); ++c) {
      const MountedCamera& mounted = half_rig.cameras[c];
      if (!exposes_beside_stamp({{mounted}})) continue;
      auto& pixels = keyframe.features[c].pixels;
      std::vector<ShownCorner> corners(pixels.size());
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        corners[i].pixel = pixels[i].cast<double>();
        const int track = keyframe.tracks[c][i];
        if (track >= 0 && odometry.tracks[at(track)].p_odom)
          corners[i].p_vehicle = T_vehicle_odom * *odometry.tracks[at(track)].p_odom;
      }
      guess_places(mounted, corners);
      for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] +=
            shift_of(mounted, moved_on(mounted, corners[i].pixel.y(), twists[k]), corners[i])
                .cast<float>();
    }
  }
}

}  // namespace roadbook
