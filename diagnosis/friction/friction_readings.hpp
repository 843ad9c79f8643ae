#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/friction/friction_sample.hpp"
#include "diagnosis/streams/streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {

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
