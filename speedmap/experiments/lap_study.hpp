#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roadnet/paths/path_frame.hpp"
#include "speedmap/property_map/knots.hpp"

namespace roadbook {

// Two laps of a real car on one road course: the map learned on the first lap predicts the second
// lap ahead of the car.
//
// The recording has no camera and no friction estimate. The property is the road's cross slope as
// the car's roll shows it: the ground's own (laps 25 % apart in speed agree with a correlation of
// 0.997, where the grip in use only has 0.84), and what a planner needs beside friction. The column
// is headed rad; its size (sd 0.85) says degrees, and as degrees it is taken. Classes are latent
// levels of it: nothing labels them.

struct LapSample {
  double time_s = 0.0;
  PathPlace place;
  double roll_deg = 0.0;
};

struct LapData {
  std::vector<LapSample> first, second;  ///< s in [0, length) of the path, in the order of time
  double length_m = 0.0;
};

/// Reads a table of the racing data set (time, x, y, vx, ..., roll, ...) and lays a closed path
/// over its first full lap. Throws BadInput for another kind of table, or for fewer than two full
/// laps.
[[nodiscard]] LapData read_laps(const std::filesystem::path& csv);

/// Mean |error| of the roll [deg] predicted along 80 m ahead, a number per horizon of the second
/// lap.
struct LapScore {
  std::string method;
  std::vector<double> mean_abs;
};
/// Property map; Kalman filter and Gaussian process on the last 100 m as in [SPM]. Two more
/// baselines have a memory, for a fair comparison: a Gaussian process on the first lap's values
/// around the horizon, and the first lap's nearest value.
[[nodiscard]] std::vector<LapScore> run_lap_study(const LapData& laps, int num_threads);

}  // namespace roadbook
