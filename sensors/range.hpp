#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sensors/effects.hpp"

namespace roadbook {

// Model of a range sensor (ultrasonic, laser): the beam model of Thrun, Burgard, Fox: Probabilistic
// Robotics, section 6.3.1.

/// Beams that leave one point, in the plane of the sensor's x and y axes.
struct RangeModel {
  std::vector<double> azimuth_rad;  ///< of each beam, from x towards y
  double max_m = 10.0;              ///< maximum range, read if nothing is nearer
  double sigma_m = 0.02;            ///< standard deviation of a hit
  Eigen::Isometry3d T_vehicle_sensor = Eigen::Isometry3d::Identity();
  double time_offset_s = 0.0;
};

/// A laser scanner behind the front bumper, 0.5 m over the ground, 41 beams over 200 degrees.
[[nodiscard]] RangeModel nominal_range_model();

/// Shares of the readings that do not show the nearest surface ("range0.X"). All zero: the nominal
/// sensor. Their sum is at most 1.
struct BeamMixture {
  double shortened = 0.0;         ///< range0.short: something unknown in front of the surface
  double maximum = 0.0;           ///< range0.maximum: no echo, read as the maximum range
  double crosstalk = 0.0;         ///< range0.crosstalk: another sensor's pulse, at any range
  double short_rate_per_m = 0.5;  ///< rate of the exponential distribution of short readings [1/m]

  [[nodiscard]] double hit() const { return 1.0 - shortened - maximum - crosstalk; }
};
[[nodiscard]] BeamMixture beam_mixture(const EffectSizes& sizes);

/// Probability densities [1/m] of a reading under each part of the mixture, equations 6.4 to 6.11.
/// For a reading at the maximum range (within 1e-9 m) they are probabilities. `expected_m`:
/// distance of the nearest surface, at most the maximum range.
struct BeamDensity {
  double hit = 0.0;
  double shortened = 0.0;
  double maximum = 0.0;
  double crosstalk = 0.0;

  [[nodiscard]] double of(const BeamMixture& mixture) const {
    return mixture.hit() * hit + mixture.shortened * shortened + mixture.maximum * maximum +
           mixture.crosstalk * crosstalk;
  }
};
[[nodiscard]] BeamDensity beam_density(
    double read_m, double expected_m, double sigma_m, double short_rate_per_m, double max_m);

/// Draws a reading from the mixture for the true distance `expected_m`. `part` (uniform in [0, 1))
/// chooses the part, `within` (uniform in [0, 1)) the value in it, and `normal` (standard normal)
/// the noise of a hit.
[[nodiscard]] double predict_range(const RangeModel& model,
                                   const BeamMixture& mixture,
                                   double expected_m,
                                   double part,
                                   double within,
                                   double normal);

}  // namespace roadbook
