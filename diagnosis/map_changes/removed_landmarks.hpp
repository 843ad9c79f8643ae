#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/map_changes/landmark_chances.hpp"
#include "diagnosis/map_changes/removed_regions.hpp"

namespace roadbook {

/// Of landmarks that a drive should see again.
struct LandmarksGone {
  std::size_t landmarks = 0;  ///< that should be seen again
  double scatter = 0.0;       ///< of places, in log odds of being found
  std::size_t tests = 0;      ///< places with enough landmarks to tell
  double gone = 0.0;          ///< landmarks that should have been found at `places` and were not,
                              ///< over their chances
  double sigma = 0.0;
  double gain = 0.0;                ///< [nats] of the places' counts
  std::vector<FoundPlace> places;   ///< where far fewer are found than elsewhere, most sure first
  std::vector<std::size_t> judged;  ///< the chances that lie at `places`
};

/// Places where things stood that stand there no more, or are hidden: named squares
/// (`gone_squares`) that touch are one place, whose share is what all of it has lost. Its `p` is
/// that of its surest square. Deterministic.
[[nodiscard]] LandmarksGone landmarks_gone(std::vector<LandmarkChance> chances,
                                           const GoneThingOptions& options = {});

/// "map.landmarks_gone": what other sessions of the map saw and this one should see and does not.
/// `twins` as for `landmark_chances`: what has moved by less than their radius is found.
/// `known`: part of the model already.
[[nodiscard]] Diagnosis diagnose_gone(const Map& map,
                                      int session,
                                      const std::vector<LandmarkTwin>& twins,
                                      const EffectSizes& known = {},
                                      const std::vector<std::string>& without = {});

}  // namespace roadbook
