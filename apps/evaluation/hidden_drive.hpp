#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sensors/effects.hpp"

namespace roadbook {

// Drives with a hidden effect, for `roadbook evaluate diagnosis`. The simulated car and its
// sensors, without images, follow a random route through a flat car park.

/// Sizes that an effect has in practice, either sign.
struct EffectRange {
  std::string name;
  double low = 0.0;
  double high = 0.0;
  bool positive = false;  ///< no negative sizes
};
/// Of the effects that wheels, steering, gyro and reference poses can carry (a wet patch needs a
/// place with a puddle and is left to the tests).
[[nodiscard]] const std::vector<EffectRange>& practical_effects();

/// Log-uniform within the range, either sign; the same for the same seed.
[[nodiscard]] double draw_size(const EffectRange& range, std::uint64_t seed);

/// Reference poses scatter by this.
inline constexpr double kReferenceSigmaM = 0.02;
inline constexpr double kReferenceSigmaRad = 0.1 * 3.14159265358979323846 / 180.0;

/// Writes a drive of about `length_m` to the folder: wheels and steering at 50 Hz, IMU at 100 Hz,
/// poses at 12.5 Hz, calibration nominal, no trace of `hidden`. Replaces a drive that is there.
void write_hidden_drive(const std::filesystem::path& folder,
                        std::uint64_t seed,
                        double length_m,
                        const EffectSizes& hidden);

}  // namespace roadbook
