#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "mapping/localisation/landmark_matches.hpp"

namespace roadbook {

/// A group of landmarks that moved together.
struct MovedThing {
  Eigen::Vector3d then = Eigen::Vector3d::Zero();   ///< centre before the move [m], map frame
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< mean [m]
  double reach_m = 0.0;  ///< largest distance of its landmarks from the centre
  std::size_t landmarks = 0;
};

/// Moved landmarks among cross-session matches. Moved objects are separated from wrong matches by
/// their neighbours, which moved by the same vector.
struct MovedLandmarks {
  std::size_t twins = 0;  ///< usable matches: unchanged or moved
  std::size_t moved = 0;
  double share = 0.0;  ///< `moved` over `twins`
  double sigma = 0.0;  ///< standard error of the share
  double gain = 0.0;   ///< [nats]: log density of large shifts predicted by their neighbours, minus
                       ///< that of shifts in a random direction
  double gain_sigma = 0.0;
  std::vector<MovedThing> things;  ///< most landmarks first
};
[[nodiscard]] MovedLandmarks moved_landmarks(const std::vector<LandmarkTwin>& twins);

/// The effect "map.moved_landmarks": landmarks at another place than other sessions of the map saw
/// them. `known`: effects in the model; only a larger share is reported. `twins`: aligned matches.
/// `without`: effects that are not searched for.
[[nodiscard]] Diagnosis diagnose_moved(const Map& map,
                                       const std::vector<LandmarkTwin>& twins,
                                       const EffectSizes& known = {},
                                       const std::vector<std::string>& without = {});

}  // namespace roadbook
