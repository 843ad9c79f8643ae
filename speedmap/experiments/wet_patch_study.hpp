#pragma once

#include <cstdint>

namespace roadbook {

// Study of the quantile of friction that speeds use: how often a speed profile needs more grip than
// a wet patch has, if the camera saw the patch and no vehicle drove on it.

struct WetPatchOptions {
  int cases = 400;
  std::uint64_t seed = 1;
  double quantile = 0.05;    ///< grip_quantile of the profile
  double mislabelled = 0.1;  ///< share of labels that name another class
  double reading_sigma = 0.05;
};

struct WetPatchResult {
  int cases = 0;
  int above_grip = 0;       ///< cases with a speed in the patch above its true grip
  int beyond_circle = 0;    ///< accelerations beyond the tyres' circle: sqrt(lat^2 + long^2) > mu g
  double mean_speed = 0.0;  ///< [m/s] in the patch
  double mean_speed_known = 0.0;  ///< were the patch's friction known
};

/// Each case is a road of 140 m with two wet patches and random frictions. The vehicle drives up to
/// and over the first patch. The second patch is only seen, and lies in a bend of random radius.
/// Deterministic.
[[nodiscard]] WetPatchResult wet_patch_study(const WetPatchOptions& options);

/// Share of locations with true presence `p` at every visit whose estimated presence is below
/// `calm` after `visits` visits. The dynamic map has `places` independent locations with this
/// prior.
[[nodiscard]] double false_calm(
    double p, double prior, double calm, int visits, int places, std::uint64_t seed);

}  // namespace roadbook
