#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sensors/rig.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

// Corners as the map knows them: tracks of one pass, joined over passes and cameras where they
// show the same corner, and triangulated with the map's poses.

struct CornerView {
  int keyframe = 0;
  int camera = 0;
  int feature = 0;
};

struct CornerTrack {
  std::vector<CornerView> views;  ///< ascending keyframe, camera; one per image
  std::optional<Eigen::Vector3d> p_map;
  bool revisited = false;  ///< joined from several tracks
};

/// A view that shows the corner of an odometry track; it may belong to another track, or to none.
struct TrackSighting {
  int track = 0;
  CornerView view;
};

/// Everything the stages after odometry look at. Keyframes of several drives follow each other.
struct MappingInput {
  VoResult odometry;
  std::vector<int> session;      ///< of each keyframe
  std::vector<Rig> half_rigs;    ///< of each session, cameras of half-size images
  std::vector<bool> has_wheels;  ///< of each session

  [[nodiscard]] const Rig& rig_of(int keyframe) const {
    return half_rigs[static_cast<std::size_t>(session[static_cast<std::size_t>(keyframe)])];
  }
  [[nodiscard]] Eigen::Vector2d pixel(const CornerView& v) const {
    return odometry.keyframes[static_cast<std::size_t>(v.keyframe)]
        .features[static_cast<std::size_t>(v.camera)]
        .pixels[static_cast<std::size_t>(v.feature)]
        .cast<double>();
  }
};

/// Tracks joined by `same` (union-find), with the views of no track that it names. Where two joined
/// tracks claim different features of one image, the earlier view stays.
[[nodiscard]] std::vector<CornerTrack> join_tracks(const VoResult& odometry,
                                                   const std::vector<TrackSighting>& same);

struct TriangulationOptions {
  double min_parallax_rad = 0.017;
  double max_error_px = 4.0;  ///< half-size image, of the worst view
  double max_range_m = 80.0;  ///< from the first view
  int num_threads = 0;
};

/// Place of the corner that `views` show; empty where parallax is too small or a view disagrees.
[[nodiscard]] std::optional<Eigen::Vector3d> triangulate_corner(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    std::span<const CornerView> views,
    const TriangulationOptions& options);

/// The same for every track of the odometry as it is, not joined.
[[nodiscard]] std::vector<std::optional<Eigen::Vector3d>> triangulate_odometry(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const TriangulationOptions& options);

/// Sets or empties `p_map` of every track.
void triangulate_corners(const MappingInput& input,
                         const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                         const TriangulationOptions& options,
                         std::vector<CornerTrack>& tracks);

}  // namespace roadbook
