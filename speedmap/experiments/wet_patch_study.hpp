#pragma once

#include <cstdint>

namespace roadbook {

// How often a speed profile needs more grip than a wet patch has, if the camera saw the patch and
// nobody drove on it: the value of the chosen quantile of friction.

struct WetPatchOptions {
  int cases = 400;
  std::uint64_t seed = 1;
  double quantile = 0.05;    ///< grip_quantile of the profile
  double mislabelled = 0.1;  ///< share of labels that name another class
  double reading_sigma = 0.05;
};

struct WetPatchResult {
  int cases = 0;
  int above_grip = 0;       ///< faster somewhere in the patch than its true friction allows
  int beyond_circle = 0;    ///< accelerations beyond the tyres' circle: sqrt(lat^2 + long^2) > mu g
  double mean_speed = 0.0;  ///< [m/s] in the patch
  double mean_speed_known = 0.0;  ///< were the patch's friction known
};

/// Each case: a road of 140 m with two wet patches, the ground's frictions drawn anew; the first
/// patch and the road up to it are driven on, the second is seen only and lies in a bend of random
/// radius. Deterministic.
[[nodiscard]] WetPatchResult wet_patch_study(const WetPatchOptions& options);

/// Share of places with true presence `p` at every visit that are called calm (below `calm`) after
/// `visits` visits, by the dynamic map on places of its own with this prior.
[[nodiscard]] double false_calm(
    double p, double prior, double calm, int visits, int places, std::uint64_t seed);

}  // namespace roadbook
