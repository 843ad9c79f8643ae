#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "mapping/localisation/landmark_matches.hpp"

namespace roadbook {

/// Things that have moved together.
struct MovedThing {
  Eigen::Vector3d then = Eigen::Vector3d::Zero();   ///< middle [m], map frame
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< mean [m]
  double reach_m = 0.0;                             ///< of the farthest from the middle
  std::size_t landmarks = 0;
};

/// What twins say. What moved is told from wrong twins by its neighbours, which moved alike.
struct MovedLandmarks {
  std::size_t twins = 0;  ///< whose shifts can be told: standing, moved
  std::size_t moved = 0;
  double share = 0.0;  ///< moved of `twins`
  double sigma = 0.0;  ///< of the share
  double gain = 0.0;   ///< [nats]: log density of far shifts predicted from their neighbours,
                       ///< less that of shifts in any direction
  double gain_sigma = 0.0;
  std::vector<MovedThing> things;  ///< most landmarks first
};
[[nodiscard]] MovedLandmarks moved_landmarks(const std::vector<LandmarkTwin>& twins);

/// "map.moved_landmarks": what stands elsewhere than the other sessions of the map saw it. `known`:
/// part of the model already, so that only more than that is a finding. `twins`: aligned.
[[nodiscard]] Diagnosis diagnose_moved(const Map& map,
                                       const std::vector<LandmarkTwin>& twins,
                                       const EffectSizes& known = {},
                                       const std::vector<std::string>& without = {});

}  // namespace roadbook
