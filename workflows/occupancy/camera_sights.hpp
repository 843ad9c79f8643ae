#pragma once

#include <vector>

#include "mapping/map.hpp"
#include "mapping/occupancy/camera_evidence.hpp"

namespace roadbook {

struct CameraSightOptions {
  double lowest_m = 0.3;   ///< height above the ground of the lowest obstacle; a lower kerb is no
                           ///< obstacle
  double highest_m = 1.6;  ///< and of the highest one; a car passes below higher things
  double max_range_m = 10.0;  ///< from a camera
  double max_sigma_m = 0.3;   ///< less certain landmarks are ignored
};

/// What a session of a map saw of the ground and of obstacles.
struct CameraSights {
  std::vector<SightKeyframe> views;  ///< the keyframes of the session
  std::vector<CameraSight> sights;
  std::size_t on_ground = 0;  ///< landmarks
  std::size_t raised = 0;     ///< landmarks
};

/// The landmarks that a session observed, by their height above the local ground. A line of sight
/// to the ground is low on the part of it that is nearer to the landmark than lowest_m over the
/// height of the camera. A raised landmark belongs to the view in the middle of its observations.
[[nodiscard]] CameraSights camera_sights(const Map& map,
                                         int session,
                                         const CameraSightOptions& options = {});

}  // namespace roadbook
