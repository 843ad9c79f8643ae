#pragma once

#include <string>
#include <vector>

#include "diagnosis/findings.hpp"
#include "diagnosis/landmark_chances.hpp"

namespace roadbook {

/// Of landmarks that a drive should see again.
struct LandmarksGone {
  std::size_t landmarks = 0;  ///< that should be seen again
  double chance = 0.0;        ///< of one that stands to be found, mean
  double scatter = 0.0;       ///< of places, in log odds of being found
  std::size_t tests = 0;      ///< places with enough landmarks to tell
  double gone = 0.0;          ///< landmarks that should have been found at `places` and were not,
                              ///< over their chances
  double sigma = 0.0;
  double gain = 0.0;               ///< [nats] of the places' counts
  std::vector<FoundPlace> places;  ///< where far fewer are found than elsewhere, most sure first
};

struct LandmarksGoneOptions {
  std::vector<double> sides_m{2.0, 4.0};  ///< of the squares that are judged, each at four offsets
  double least_expected = 4.0;            ///< landmarks to be found in one
  double try_at = 0.003;  ///< probability of a square that is taken for fallen at first
  double level = 0.005;   ///< of a false alarm in a drive
};

/// Places where things stood that stand there no more, or are hidden: squares in which fewer
/// landmarks are found again than chance and the scatter between places allow. Bonferroni over
/// all squares. Deterministic.
[[nodiscard]] LandmarksGone landmarks_gone(std::vector<LandmarkChance> chances,
                                           const LandmarksGoneOptions& options = {});

/// "map.landmarks_gone": what other sessions of the map saw and this one should see and does not.
/// `twins` as for `landmark_chances`: what has moved by less than their radius is found.
/// `known`: part of the model already.
[[nodiscard]] Diagnosis diagnose_gone(const Map& map,
                                      int session,
                                      const std::vector<LandmarkTwin>& twins,
                                      const EffectSizes& known = {},
                                      const std::vector<std::string>& without = {});

}  // namespace roadbook
