#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sensors/effects.hpp"

namespace roadbook {

// Drives with a hidden effect, for `roadbook evaluate diagnosis`. The simulated car and its
// sensors, without images, follow a random route through a flat car park.

/// The practical sizes of an effect, with either sign.
struct EffectRange {
  std::string name;
  double low = 0.0;
  double high = 0.0;
  bool positive = false;  ///< no negative sizes
};
/// Returns the effects of wheels, steering, gyro and reference poses. A wet patch needs a place
/// with a puddle, and only the tests cover it.
[[nodiscard]] const std::vector<EffectRange>& practical_effects();

/// Draws a size, log-uniform within the range, with either sign. The same seed gives the same size.
[[nodiscard]] double draw_size(const EffectRange& range, std::uint64_t seed);

/// Standard deviations of the reference poses.
inline constexpr double kReferenceSigmaM = 0.02;
inline constexpr double kReferenceSigmaRad = 0.1 * 3.14159265358979323846 / 180.0;

/// Writes a drive of about `length_m` to the folder: wheels and steering at 50 Hz, IMU at 100 Hz,
/// poses at 12.5 Hz. The calibration is nominal and shows no trace of `hidden`. Replaces an
/// existing drive.
void write_hidden_drive(const std::filesystem::path& folder,
                        std::uint64_t seed,
                        double length_m,
                        const EffectSizes& hidden);

}  // namespace roadbook
