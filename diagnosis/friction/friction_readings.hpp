#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/streams/streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {

/// One friction reading with everything it might depend on.
struct FrictionSample {
  double t_s = 0.0;
  double friction = 0.0;
  double sigma = 0.05;         ///< stated
  int surface = 0;             ///< class under the wheels, as labelled or inferred
  double temperature_c = 0.0;  ///< kFrictionReference where none is logged
  double x = 0.0, y = 0.0, heading = 0.0;
  double speed = 0.0;                 ///< [m/s]
  double acceleration = 0.0;          ///< along [m/s^2]
  double lateral_acceleration = 0.0;  ///< to the left [m/s^2]
  double yaw_rate = 0.0;              ///< [rad/s]
};

/// A drive's friction readings at its reference poses. `notes`: why there are none, if so.
struct FrictionReadings {
  std::vector<FrictionSample> samples;
  bool has_surface = true;  ///< labelled; else inferred from the readings themselves
  bool has_temperature = false;
  std::vector<ColumnCovariate> columns{};  ///< further ones that the log has, which vary
  std::vector<std::string> notes;
};

/// Surfaces that were inferred are numbered from here on: no class of a recording.
inline constexpr int kInferredSurface = 1000;

/// A reading as recorded.
struct RawFriction {
  double t_s = 0.0;
  double friction = 0.0;
  double sigma = 0.05;
  std::optional<int> surface;
  std::optional<double> temperature_c;
};

/// Speed and accelerations come from the poses (`half_window_of`): not from the friction
/// sensor, whose noise they would share. Readings before the first and after the last pose are left
/// out.
[[nodiscard]] FrictionReadings friction_readings(const std::vector<PoseSample>& poses,
                                                 const std::vector<RawFriction>& raw);
/// The poses' stamps are `late_s` after those that readings of the same moment have.
[[nodiscard]] FrictionReadings friction_readings(const Drive& drive,
                                                 const std::vector<PoseSample>& poses,
                                                 double late_s = 0.0);

}  // namespace roadbook
