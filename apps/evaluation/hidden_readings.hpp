#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "apps/evaluation/hidden_drive.hpp"

namespace roadbook {

// Drives with a hidden effect in the readings of a friction sensor, range scanner or detector of
// people, for `roadbook evaluate diagnosis`. They use the simulation's places, drivers and sensors,
// without images.

enum class HiddenKind {
  kMotion,    ///< wheels, steering, gyro, reference poses (`write_hidden_drive`)
  kFriction,  ///< 15 minutes of laps on a country road, readings at 10 Hz
  kRange,     ///< two laps of the car park `zurich`, 240 m, 41 beams at 10 Hz
  kDetector,  ///< three laps of `zurich`, 360 m, with as many people as at noon, five frames a
              ///< second
};

/// Returns the effects of friction0, range0 and detector.
[[nodiscard]] const std::vector<EffectRange>& practical_reading_effects();

/// Returns the kind from the name of the effect: "friction0.X" is of friction, ...
[[nodiscard]] HiddenKind kind_of_effect(const std::string& effect);

/// Writes a drive to the folder: reference poses with the noise of `write_hidden_drive`, and the
/// sensor's readings. The calibration is nominal and shows no trace of `hidden`. Replaces an
/// existing drive. Not for `kMotion`.
void write_hidden_readings(const std::filesystem::path& folder,
                           std::uint64_t seed,
                           HiddenKind kind,
                           const EffectSizes& hidden);

}  // namespace roadbook
