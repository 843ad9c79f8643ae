#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/map_changes/landmark_redetections.hpp"
#include "diagnosis/map_changes/removed_regions.hpp"

namespace roadbook {

/// Removed landmarks among those that a drive should detect again.
struct RemovedLandmarks {
  std::size_t landmarks = 0;  ///< that should be detected again
  double scatter = 0.0;       ///< variation between regions [log odds]
  std::size_t tests = 0;      ///< cells with enough landmarks for a test
  double gone =
      0.0;  ///< landmarks expected but not found in `places`, over their redetection probability
  double sigma = 0.0;
  double gain = 0.0;                ///< [nats] log likelihood ratio of the counts in `places`
  std::vector<FoundPlace> places;   ///< removed regions, most significant first
  std::vector<std::size_t> judged;  ///< indices of the landmarks in `places`
};

/// Regions where objects were removed or are hidden. Adjacent cells named by `removed_regions` form
/// one region, whose share counts all its landmarks. Its `p` is that of its most significant cell.
/// Deterministic.
[[nodiscard]] RemovedLandmarks removed_landmarks(std::vector<LandmarkRedetection> chances,
                                                 const RemovedRegionOptions& options = {});

/// The effect "map.landmarks_gone": landmarks of other sessions that this one should detect and
/// does not. `twins`: as for `landmark_redetections`; landmarks that moved by less than the match
/// radius count as found. `known`: effects in the model. `without`: effects that are not searched
/// for.
[[nodiscard]] Diagnosis diagnose_gone(const Map& map,
                                      int session,
                                      const std::vector<LandmarkTwin>& twins,
                                      const EffectSizes& known = {},
                                      const std::vector<std::string>& without = {});

}  // namespace roadbook
