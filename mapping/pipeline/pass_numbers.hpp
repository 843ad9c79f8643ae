#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "mapping/joined_tracks.hpp"

namespace roadbook {

/// When two keyframes see one place in two passes.
struct PlacePassOptions {
  double radius_m = 2.5;       ///< between their poses
  double heading_rad = 0.7;    ///< between their headings
  double min_travel_m = 10.0;  ///< driven between them, if no gap lies between them
};

/// A keyframe of an earlier pass over the place of `keyframe`.
struct EarlierPass {
  std::size_t keyframe;
  std::size_t earlier;
  Eigen::Vector3d way_m;  ///< from the earlier to the later pose, in the earlier vehicle's frame
};

/// Calls `visit` for each pair of keyframes of two passes over one place, in the order of the later
/// one. Linear in the number of pairs.
void visit_earlier_passes(const MappingInput& input,
                          const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                          const PlacePassOptions& options,
                          const std::function<void(const EarlierPass&)>& visit);

/// Number of earlier passes over the place of each keyframe, counted beside it: 0 in the first
/// pass. Neighbouring places whose passes began at different times may differ. `piece` of each
/// keyframe: only those of one piece have a common frame and are compared. `counts`: passes of
/// other keyframes are not counted, although they have a number.
[[nodiscard]] std::vector<int> pass_numbers(const MappingInput& input,
                                            const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                            const std::vector<int>& piece,
                                            const std::vector<bool>& counts,
                                            const PlacePassOptions& options);

}  // namespace roadbook
