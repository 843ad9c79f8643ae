#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sensors/effects.hpp"

namespace roadbook {

// What a range sensor (ultrasonic, laser) reads along a beam: the beam model of Thrun, Burgard,
// Fox: Probabilistic Robotics, section 6.3.1.

/// Beams that leave one point, in the plane of the sensor's x and y axes.
struct RangeModel {
  std::vector<double> azimuth_rad;  ///< of each beam, from x towards y
  double max_m = 10.0;              ///< nothing nearer: reads this
  double sigma_m = 0.02;            ///< of a hit
  Eigen::Isometry3d T_vehicle_sensor = Eigen::Isometry3d::Identity();
  double time_offset_s = 0.0;
};

/// A laser scanner behind the front bumper, 0.5 m over the ground, 41 beams over 200 degrees.
[[nodiscard]] RangeModel nominal_range_model();

/// Shares of the readings that are not of the nearest surface ("range0.X"); all zero: the nominal
/// sensor. Sum at most 1.
struct BeamMixture {
  double shortened = 0.0;         ///< range0.short: something unknown before the surface
  double maximum = 0.0;           ///< range0.maximum: no echo, read as the maximum
  double crosstalk = 0.0;         ///< range0.crosstalk: of another sensor's pulse, anywhere
  double short_rate_per_m = 0.5;  ///< short readings thin out with distance by this

  [[nodiscard]] double hit() const { return 1.0 - shortened - maximum - crosstalk; }
};
[[nodiscard]] BeamMixture beam_mixture(const EffectSizes& sizes);

/// Densities [1/m] of a reading under each part, equations 6.4 to 6.11; of a reading at the maximum
/// (within 1e-9 m) probabilities. `expected_m`: distance of the nearest surface, at most the
/// maximum range.
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

/// The reading that the mixture makes of `expected_m`: which part is chosen by `part`, where in it
/// by `within` (both uniform in [0, 1)), the noise of a hit by `normal`.
[[nodiscard]] double predict_range(const RangeModel& model,
                                   const BeamMixture& mixture,
                                   double expected_m,
                                   double part,
                                   double within,
                                   double normal);

}  // namespace roadbook
