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

// The one who hides. A vehicle and its sensors, integrated with plain small steps, that shares
// with diagnosis nothing but the declared meaning of each effect (docs/reference/effects.md).

struct HiddenDriveOptions {
  std::uint64_t seed = 1;
  double length_m = 300.0;
  bool straight = false;  ///< 60 m straight ahead: little can be told apart
  bool oval = false;      ///< once round a smooth oval, instead of a car park
  double puddle_radius_m = 3.0;
  Secret secret;
  /// Signal of the car that effects "..._by_column" follow, of mean 0 and about unit spread.
  std::function<double(double t_s)> acting = [](double) { return 0.0; };
  double pose_sigma_m = 0.02;
  double pose_sigma_rad = 0.1 * 3.14159265358979323846 / 180.0;
  double steering_sigma_rad = 0.002;
  double steering_step_rad = 0.0;  ///< its readings are rounded to
};

struct Recording {
  WheelModel wheel_model;  ///< nominal: what sensor.yaml says
  std::vector<WheelReading> wheels;
  std::vector<ImuReading> imu;
  std::vector<TimedPose> poses;
};

/// Drives a random car-park route; the same for the same options.
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

/// An effect that no catalogue lists, and what may be said of it instead: hook and covariate.
struct OutsideEffect {
  EffectRange range;  ///< "outside.X" in the secret
  std::vector<std::pair<std::string, std::string>> readings;
};
/// Offset of the gyro that grows with time, steering that shifts with speed, tyres that grow with
/// time, a reference heading that errs with heading (a compass), a left tyre that rolls further
/// under the load of a bend.
[[nodiscard]] const std::vector<OutsideEffect>& outside_effects();

/// Size drawn log-uniformly from the range, sign by chance.
[[nodiscard]] double draw_size(const EffectRange& range, std::uint64_t seed);

}  // namespace roadbook::test
