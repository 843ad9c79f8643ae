#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"

namespace roadbook {

/// One view of a landmark from a pose of the session.
struct Sight {
  int pose = 0;
  const Observation* seen = nullptr;
};

/// The views of a landmark in one pass.
struct ViewTrack {
  int landmark = 0;
  std::vector<Sight> sights;  ///< ascending poses
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  /// Share of inconsistent views at the poses of the map, in tenths, rounded up. Tracks often join
  /// several corners.
  int tenths_off = 0;
};

/// The usable tracks: for each landmark and pass the views within `reach` keyframes of the nearest
/// keyframe, to either side. `pose_of`: index in `poses` of each keyframe of the map, -1 for other
/// sessions. Tracks with fewer than 4 views or with too little parallax for their depth are left
/// out, because a fit would move them far. Landmarks ascend.
[[nodiscard]] std::vector<ViewTrack> view_tracks(const Map& map,
                                                 int session,
                                                 const std::vector<int>& pose_of,
                                                 const std::vector<BundlePose>& poses,
                                                 int reach);

}  // namespace roadbook
