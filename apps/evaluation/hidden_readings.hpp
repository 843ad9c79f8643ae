#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "apps/evaluation/hidden_drive.hpp"

namespace roadbook {

// Drives with a hidden effect in what friction sensor, range scanner or detector of people say, for
// `roadbook evaluate diagnosis`: the simulation's places, drivers and sensors, without images.

enum class HiddenKind {
  kMotion,    ///< wheels, steering, gyro, reference poses (`write_hidden_drive`)
  kFriction,  ///< a quarter of an hour of laps of a country road, readings at 10 Hz
  kRange,     ///< two rounds of the car park `zurich`, 240 m, 41 beams at 10 Hz
  kDetector,  ///< three rounds of it, 360 m, with as many people as at noon, five looks a second
};

/// Of friction0, range0 and detector.
[[nodiscard]] const std::vector<EffectRange>& practical_reading_effects();

/// By the name of the effect: "friction0.X" is of friction, ...
[[nodiscard]] HiddenKind kind_of_effect(const std::string& effect);

/// Writes a drive to the folder: reference poses that scatter as those of `write_hidden_drive`, the
/// sensor's readings, calibration nominal, no trace of `hidden`. Replaces a drive that is there.
/// Not for `kMotion`.
void write_hidden_readings(const std::filesystem::path& folder,
                           std::uint64_t seed,
                           HiddenKind kind,
                           const EffectSizes& hidden);

}  // namespace roadbook
