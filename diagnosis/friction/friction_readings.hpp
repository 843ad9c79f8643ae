#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/streams/streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {

/// One friction reading with all quantities that it may depend on.
struct FrictionSample {
  double t_s = 0.0;
  double friction = 0.0;
  double sigma = 0.05;         ///< stated
  int surface = 0;             ///< surface class under the wheels, labelled or inferred
  double temperature_c = 0.0;  ///< kFrictionReference if no temperature is logged
  double x = 0.0, y = 0.0, heading = 0.0;
  double speed = 0.0;                 ///< [m/s]
  double acceleration = 0.0;          ///< longitudinal [m/s^2]
  double lateral_acceleration = 0.0;  ///< to the left [m/s^2]
  double yaw_rate = 0.0;              ///< [rad/s]
};

/// The friction readings of a drive at its reference poses. `notes`: why there are none, if so.
struct FrictionReadings {
  std::vector<FrictionSample> samples;
  bool has_surface = true;  ///< surfaces are labelled; else inferred from the readings
  bool has_temperature = false;
  std::vector<ColumnCovariate> columns{};  ///< further logged columns that vary
  std::vector<std::string> notes;
};

/// First number of inferred surfaces; recorded classes are smaller.
inline constexpr int kInferredSurface = 1000;

/// A reading as recorded.
struct RawFriction {
  double t_s = 0.0;
  double friction = 0.0;
  double sigma = 0.05;
  std::optional<int> surface;
  std::optional<double> temperature_c;
};

/// Adds pose, speed and accelerations to the readings, from smoothed poses (`half_window_of`).
/// Values of the friction sensor are not used, because its noise would enter them. Readings outside
/// the poses are left out.
[[nodiscard]] FrictionReadings friction_readings(const std::vector<PoseSample>& poses,
                                                 const std::vector<RawFriction>& raw);
/// The same for a drive. `late_s` [s]: stamps of the poses minus stamps of readings of the same
/// time.
[[nodiscard]] FrictionReadings friction_readings(const Drive& drive,
                                                 const std::vector<PoseSample>& poses,
                                                 double late_s = 0.0);

}  // namespace roadbook
