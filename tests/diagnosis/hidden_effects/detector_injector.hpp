#pragma once

#include <filesystem>

#include "tests/diagnosis/hidden_effects/injector.hpp"

namespace roadbook::test {

// Hides effects in the detections of a pedestrian detector, along a drive of 300 m through a car
// park with standing and walking pedestrians. Shares only the names of effects with diagnosis.

struct DetectorSecret {
  std::uint64_t seed = 1;
  Secret secret;
  /// Beside the way at any time; 0: as at noon. Of 240 spaces along 300 m of lane 85 % are taken
  /// for an hour each, and with every car that comes or goes 1.7 people are on foot or at its boot
  /// for three to four minutes: 30 to 50.
  std::uint64_t people = 0;
  bool looks = true;  ///< the table of when people were looked for is written
};

/// Effects that no catalogue has: "pitch" [rad], the camera looks down by more than is known, so
/// that feet come out farther away by range^2 over the camera's height; "late" [s], stamps are late
/// by this; "side" [1], log odds of finding somebody fall by this for each unit of the bearing's
/// sine, to the left.
void write_detector_drive(const DetectorSecret& hidden, const std::filesystem::path& folder);

/// Practical ranges of the two effects.
[[nodiscard]] const std::vector<EffectRange>& detector_ranges();
/// Practical ranges of the effects outside the catalogue.
[[nodiscard]] const std::vector<EffectRange>& outside_detector_ranges();

}  // namespace roadbook::test
