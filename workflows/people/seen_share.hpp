#pragma once

#include <vector>

#include "semantics/people/person_camera.hpp"
#include "speedmap/presence/visit_evidence.hpp"

namespace roadbook {

/// A detector need not find people whose visible share is below this value: "reasonable" of Dollar,
/// Wojek, Schiele and Perona, Pedestrian Detection, PAMI 2012 (less than 35 % occluded).
inline constexpr double kReasonableShare = 0.65;

/// A person in the view of one camera, without occlusion.
struct PersonInView {
  PersonBox box;
  double range_m = 0.0;  ///< from the camera, over the ground
};
[[nodiscard]] PersonInView person_in_view(int camera,
                                          const MountedCamera& mounted,
                                          const Eigen::Vector3d& foot_vehicle,
                                          double height_m);

/// Returns the visible share of a person's body, which is half a metre wide. `others` hide it if
/// they are nearer to the camera. `blockers` (world frame, as high as people) hide it too.
[[nodiscard]] double seen_share(const PersonInView& person,
                                const std::vector<PersonInView>& others,
                                const MountedCamera& mounted,
                                const Eigen::Isometry3d& T_world_vehicle,
                                const std::vector<SightBlocker>& blockers);

}  // namespace roadbook
