#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mapping/corner_tracks.hpp"
#include "vo/ground_scale.hpp"

namespace roadbook {

// The driven surface as the reference for height and scale. A corner of the ground lies at height 0
// in the frame of the vehicle pose that stands nearest to it: there the pitch of a camera that
// looks ahead no longer matters, only its height does.

/// For a point: the nearest keyframe and the point's place in its vehicle frame.
struct GroundView {
  int keyframe = -1;  ///< -1: no pose near enough
  Eigen::Vector3d p_vehicle = Eigen::Vector3d::Zero();
};

struct GroundOptions {
  double ahead_m = 1.5;    ///< how far before or behind the rear axle the point may lie
  double beside_m = 1.6;   ///< and how far to the side: beyond the lane begin kerbs
  double height_m = 0.06;  ///< heights of ground points are smaller than this
};

/// Nearest pose of each point of `tracks` (those without a place: keyframe -1), among the
/// keyframes within 3 m of travel or `views` of the track.
[[nodiscard]] std::vector<GroundView> view_from_above(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const std::vector<CornerTrack>& tracks,
    const GroundOptions& options = {});

/// Height at which most of the points near the driven line lie [m]: 0 where the scale is right,
/// else the error of the scale times the cameras' height. 0 where too few points tell.
[[nodiscard]] double ground_level(const std::vector<GroundView>& views,
                                  const GroundOptions& options = {});

/// Whether a point seen so belongs to the ground, which lies at `level_m`.
[[nodiscard]] bool on_ground(const GroundView& view,
                             double level_m,
                             const GroundOptions& options = {});

struct ScaleProfile {
  std::vector<double> factor;  ///< of the motion from each keyframe to the next
  bool found = false;
  double sigma = 0.0;  ///< relative, of the whole
};

/// Factor that brings odometry without wheels to metres, along the drive: the cameras' height in
/// windows of `window` keyframes, smoothed. `piece` keeps stretches with gaps between them apart.
[[nodiscard]] ScaleProfile ground_scale_profile(const MappingInput& input,
                                                const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                                const std::vector<CornerTrack>& tracks,
                                                int window = 25);

}  // namespace roadbook
