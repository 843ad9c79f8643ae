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

/// Errors of the reference poses that last, as those of GNSS with or without an INS: independent
/// first-order Gauss-Markov processes of x, y and heading, beside white noise of a drawn size.
struct LastingReference {
  double time_s = 0.0;  ///< correlation time; 0: the poses have white noise alone
  double position_m = 0.0;
  double heading_rad = 0.0;
  double white_m = kReferenceSigmaM;
  double white_rad = kReferenceSigmaRad;
};
/// Draws sizes log-uniform: 1 to 50 cm and 0.03 to 0.5 degrees, white noise of 0.3 to 3 cm and 0.02
/// to 0.1 degrees. The same seed gives the same sizes.
[[nodiscard]] LastingReference draw_lasting_reference(double time_s, std::uint64_t seed);

/// Writes a drive of about `length_m` to the folder: wheels and steering at 50 Hz, IMU at 100 Hz,
/// poses at 12.5 Hz. The calibration is nominal and shows no trace of `hidden`. Replaces an
/// existing drive.
void write_hidden_drive(const std::filesystem::path& folder,
                        std::uint64_t seed,
                        double length_m,
                        const EffectSizes& hidden,
                        const LastingReference& reference = {});

}  // namespace roadbook
