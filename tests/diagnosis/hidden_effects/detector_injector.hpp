#pragma once

#include <filesystem>

#include "tests/diagnosis/hidden_effects/injector.hpp"

namespace roadbook::test {

// Hides effects in the detections of a pedestrian detector, along a drive of 300 m through a car
// park with standing and walking pedestrians. Shares only the names of effects with diagnosis.

struct DetectorSecret {
  std::uint64_t seed = 1;
  Secret secret;
  /// Number of pedestrians next to the route at any time; 0: as at noon. At noon, cars occupy 85 %
  /// of 240 spaces along 300 m of lane, each for an hour. For each car that arrives or leaves, 1.7
  /// people walk or load the boot for three to four minutes. This gives 30 to 50 pedestrians.
  std::uint64_t people = 0;
  bool looks = true;  ///< the table of when people were looked for is written
};

/// Effects outside the catalogue. "pitch" [rad]: the camera looks down by this angle more than its
/// calibration states, so feet appear farther away by range^2 over the camera's height. "late" [s]:
/// stamps are late by this time. "side" [1]: the log odds of a detection fall by this number for
/// each unit of the bearing's sine, to the left.
void write_detector_drive(const DetectorSecret& hidden, const std::filesystem::path& folder);

/// Practical ranges of the two effects.
[[nodiscard]] const std::vector<EffectRange>& detector_ranges();
/// Practical ranges of the effects outside the catalogue.
[[nodiscard]] const std::vector<EffectRange>& outside_detector_ranges();

}  // namespace roadbook::test
