#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"

namespace roadbook {

/// A view of a landmark from a pose of the session.
struct Sight {
  int pose = 0;
  const Observation* seen = nullptr;
};

/// What one pass sees of a landmark.
struct ViewTrack {
  int landmark = 0;
  std::vector<Sight> sights;  ///< ascending poses
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  /// Share of its views that are far off for their camera by the map's own poses, in tenths,
  /// rounded up: tracks are often joined of several corners.
  int tenths_off = 0;
};

/// Of each landmark and pass the views of `reach` keyframes to either side of the nearest one.
/// `pose_of`: index in `poses` of each of the map's keyframes, -1 for those of other sessions. Left
/// out are tracks of fewer than 4 views, or without the parallax that tells how far they are: a
/// step towards a better fit would throw them about. Ascending landmarks.
[[nodiscard]] std::vector<ViewTrack> view_tracks(const Map& map,
                                                 int session,
                                                 const std::vector<int>& pose_of,
                                                 const std::vector<BundlePose>& poses,
                                                 int reach);

}  // namespace roadbook
