#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roadnet/paths/path_frame.hpp"
#include "speedmap/property_map/knots.hpp"

namespace roadbook {

// Two laps of a real car on one road course: the map learned on the first lap predicts the property
// ahead of the car on the second lap.
//
// The recording has no camera and no friction estimate. The property is the cross slope of the
// road, measured as the roll of the car. It belongs to the ground: two laps with speeds 25 % apart
// correlate by 0.997 (the grip in use by 0.84). The head of the column says rad, but its standard
// deviation of 0.85 shows degrees, so it is read as degrees. Classes are latent levels of the
// slope, without labels.

struct LapSample {
  double time_s = 0.0;
  PathPlace place;
  double roll_deg = 0.0;
};

struct LapData {
  std::vector<LapSample> first, second;  ///< s in [0, length) of the path, in the order of time
  double length_m = 0.0;
};

/// Reads a table of the racing data set (time, x, y, vx, ..., roll, ...) and fits a closed path to
/// its first full lap. Throws BadInput for another kind of table, or for fewer than two full laps.
[[nodiscard]] LapData read_laps(const std::filesystem::path& csv);

/// Mean |error| of the roll [deg] predicted along 80 m ahead, one number for each horizon of the
/// second lap.
struct LapScore {
  std::string method;
  std::vector<double> mean_abs;
};
/// Scores the property map and its baselines: Kalman filter and Gaussian process on the last 100 m
/// as in [SPM]. Two more baselines also use the first lap, for a fair comparison: a Gaussian
/// process on its values around the horizon, and its nearest value.
[[nodiscard]] std::vector<LapScore> run_lap_study(const LapData& laps, int num_threads);

}  // namespace roadbook
