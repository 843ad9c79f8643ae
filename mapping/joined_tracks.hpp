#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sensors/rig.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

// Tracks joined over passes and cameras, from which landmarks are made.
//
// A key point is a corner in one image. Visual odometry links the key points of one camera in
// successive keyframes to tracks (vo/keyframe_track.hpp). Loop closures and revisits show which
// tracks belong to the same corner of the scene: these are joined and triangulated with the map's
// poses. A joined track with a position becomes a landmark, its key points become observations.

/// Names one key point: index of its keyframe, camera and feature (VoKeyframe::features).
struct KeyPointId {
  int keyframe = 0;
  int camera = 0;
  int feature = 0;
};

/// All key points that show one corner of the scene.
struct JoinedTrack {
  std::vector<KeyPointId> views;         ///< ascending keyframe, camera; at most one per image
  std::optional<Eigen::Vector3d> p_map;  ///< triangulated position [m, map]
  bool revisited = false;                ///< joined from several odometry tracks
};

/// A key point that shows the same corner as an odometry track. It may belong to another track.
struct TrackMatch {
  int track = 0;  ///< index in VoResult::tracks
  KeyPointId view;
};

/// Input of the stages after odometry. The keyframes of several drives follow each other.
struct MappingInput {
  VoResult odometry;
  std::vector<int> session;      ///< of each keyframe
  std::vector<Rig> half_rigs;    ///< of each session, cameras of half-size images
  std::vector<bool> has_wheels;  ///< of each session

  [[nodiscard]] const Rig& rig_of(int keyframe) const {
    return half_rigs[static_cast<std::size_t>(session[static_cast<std::size_t>(keyframe)])];
  }
  /// Pixel of a key point in the half-size image.
  [[nodiscard]] Eigen::Vector2d pixel(const KeyPointId& v) const {
    return odometry.keyframes[static_cast<std::size_t>(v.keyframe)]
        .features[static_cast<std::size_t>(v.camera)]
        .pixels[static_cast<std::size_t>(v.feature)]
        .cast<double>();
  }
};

/// Joins the tracks of `odometry` by the matches `same` (union-find). Matched key points without a
/// track are added. Where joined tracks have two key points in one image, the first one stays.
/// Tracks with fewer than two key points are left out.
[[nodiscard]] std::vector<JoinedTrack> join_tracks(const VoResult& odometry,
                                                   const std::vector<TrackMatch>& same);

struct TriangulationOptions {
  double min_parallax_rad = 0.017;  ///< largest angle between two rays is at least this
  double max_error_px = 4.0;        ///< half-size image, of the worst key point
  double max_range_m = 80.0;        ///< from the camera of the first key point
  int num_threads = 0;
};

/// Position [m, map] of the corner that `views` show. Empty if the parallax is too small, a key
/// point disagrees or the corner is too far away.
[[nodiscard]] std::optional<Eigen::Vector3d> triangulate_key_points(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    std::span<const KeyPointId> views,
    const TriangulationOptions& options);

/// Positions [m, map] of the odometry's own tracks, before they are joined.
[[nodiscard]] std::vector<std::optional<Eigen::Vector3d>> triangulate_odometry_tracks(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const TriangulationOptions& options);

/// Triangulates every joined track: sets or clears its `p_map`.
void triangulate_tracks(const MappingInput& input,
                        const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                        const TriangulationOptions& options,
                        std::vector<JoinedTrack>& tracks);

}  // namespace roadbook
