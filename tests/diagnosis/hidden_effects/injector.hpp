#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "drive/readings.hpp"
#include "sensors/wheels.hpp"
#include "tests/diagnosis/hidden_effects/secret.hpp"

namespace roadbook::test {

// Independent simulation that hides effects: a vehicle and its sensors, integrated in small steps.
// Shares only the declared meaning of effects with diagnosis (docs/reference/effects.md).

struct HiddenDriveOptions {
  std::uint64_t seed = 1;
  double length_m = 300.0;
  bool straight = false;  ///< 60 m straight ahead: few effects are separable
  bool oval = false;      ///< once round a smooth oval, instead of a car park
  double puddle_radius_m = 3.0;
  Secret secret;
  /// Signal that drives the effects "..._by_column": mean 0, about unit variance.
  std::function<double(double t_s)> acting = [](double) { return 0.0; };
  double pose_sigma_m = 0.02;
  double pose_sigma_rad = 0.1 * 3.14159265358979323846 / 180.0;
  double steering_sigma_rad = 0.002;
  double steering_step_rad = 0.0;  ///< its readings are rounded to
};

/// A drive whose poses have errors that last `time_s`, of 1 to 50 cm and 0.03 to 0.5 degrees.
[[nodiscard]] HiddenDriveOptions drive_with_lasting_errors(double time_s, std::uint64_t seed);

struct Recording {
  WheelModel wheel_model;  ///< nominal: what sensor.yaml says
  std::vector<WheelReading> wheels;
  std::vector<ImuReading> imu;
  std::vector<TimedPose> poses;
};

/// Records a random car-park route; deterministic in the options.
[[nodiscard]] Recording record_drive(const HiddenDriveOptions& options);

/// Writes it as a native drive.
void write_recording(const Recording& recording, const std::filesystem::path& folder);

/// Practical range of an effect's size, either sign.
struct EffectRange {
  std::string name;
  double low = 0.0;
  double high = 0.0;
  bool positive = false;  ///< shares, variances: no negative sizes
};
[[nodiscard]] const std::vector<EffectRange>& practical_ranges();

/// An effect outside the catalogue, with the stream and covariate that diagnosis may report.
struct OutsideEffect {
  EffectRange range;  ///< "outside.X" in the secret
  std::vector<std::pair<std::string, std::string>> readings;
};
/// Gyro offset growing with time; steering shift with speed; tyre radius growing with time;
/// reference heading error by heading (a compass); left tyre radius growing with lateral load.
[[nodiscard]] const std::vector<OutsideEffect>& outside_effects();

/// Log-uniform size from the range with a random sign.
[[nodiscard]] double draw_size(const EffectRange& range, std::uint64_t seed);

}  // namespace roadbook::test
