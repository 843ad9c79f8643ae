#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sensors/rig.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

// Corners of an earlier keyframe that a later keyframe shows again.

/// A corner of the earlier keyframe.
struct KnownCorner {
  int camera = 0;
  int feature = 0;
  Eigen::Vector3d p_vehicle = Eigen::Vector3d::Zero();  ///< place in that keyframe's vehicle frame
  const Descriptor* descriptor = nullptr;
};

/// A corner (index) and the key point of the later keyframe that shows it.
struct CornerMatch {
  int corner = 0;
  int camera = 0;
  int feature = 0;
};

struct CornerMatchOptions {
  int max_hamming = 105;    ///< of 512 bits
  double max_ratio = 0.88;  ///< nearest over second-nearest descriptor distance
};

/// Corners of a keyframe with a known place within 60 m. They point into `odometry`.
[[nodiscard]] std::vector<KnownCorner> known_corners(const VoResult& odometry, int keyframe);

/// Nearest descriptor; of several corners that choose one feature the nearest. A place may be
/// passed the other way round, so that another camera sees it: with `any_camera` all cameras are
/// searched.
[[nodiscard]] std::vector<CornerMatch> match_by_descriptor(const std::vector<KnownCorner>& corners,
                                                           const VoKeyframe& later,
                                                           bool any_camera,
                                                           const CornerMatchOptions& options);

/// With the pose known, every corner is searched within `radius_px` of its place in the image.
[[nodiscard]] std::vector<CornerMatch> match_by_pose(const Rig& rig,
                                                     const std::vector<KnownCorner>& corners,
                                                     const VoKeyframe& later,
                                                     const Eigen::Isometry3d& T_later_earlier,
                                                     double radius_px);

}  // namespace roadbook
