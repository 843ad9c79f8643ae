#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace roadbook {

// The experiment of [SPM, section 4]. The paper leaves most of its parameters open. All chosen
// values are here and in docs/spm_experiment.yaml, which `roadbook evaluate spm --config` reads.

struct SpmExperimentOptions {
  std::uint64_t seed = 1;
  int maps = 10;

  // The road: two miles, its heading three sinusoids [rad, m].
  double length_m = 3218.688;
  std::vector<double> heading_amplitude_rad = {1.0, 0.5, 0.12};
  std::vector<double> heading_wavelength_m = {1100.0, 420.0, 150.0};
  int segments = 40;  ///< M
  int degree = 6;
  double half_width_m = 6.0;    ///< e in +- this
  double spacing_m = 1.0;       ///< of the knots, along and across
  double kernel_width_m = 2.0;  ///< D

  // Ground: gravel beyond border + wander * GP(s), wet where a 2-D GP exceeds a level.
  double gravel_from_m = 3.3;
  double gravel_wander_m = 0.8;
  double gravel_wander_length_m = 25.0;
  double wet_level = 1.0;  ///< [sigma]
  double wet_length_s_m = 12.0;
  double wet_length_e_m = 2.0;

  // The truth: gravel, asphalt, wet.
  std::vector<double> friction = {0.60, 0.95, 0.45};
  std::vector<double> friction_sigma = {0.06, 0.04, 0.05};
  double friction_spread = 0.05;  ///< relative, per map
  double true_lambda = 50.0;
  double true_alpha = 50.0;
  double true_purity = 30.0;  ///< Dirichlet 1 + this for the knot's class

  // The drive.
  double speed_mps = 20.0;
  double semantics_hz = 20.0;
  double friction_hz = 40.0;
  std::vector<double> weave_amplitude_m = {2.2, 0.8};
  std::vector<double> weave_wavelength_m = {140.0, 53.0};
  std::vector<double> weave_phase_rad = {0.0, 1.0};

  // The camera: a pinhole looking ahead.
  int image_width = 1280;
  int image_height = 720;
  double focal_px = 900.0;
  double camera_height_m = 1.4;
  double camera_pitch_rad = 0.0349065850398866;  ///< 2 degrees down
  double range_min_m = 5.0;
  double range_max_m = 90.0;
  double pixel_spacing_m = 0.78;  ///< pixels are thinned to this on the ground: 822 a frame

  // The prior.
  std::vector<double> prior_counts = {1.0, 5.0, 1.0};
  double prior_error = 0.9;  ///< each parameter times 1 + U(-this, this)

  // Positions of the scores.
  double score_until_m = 600.0;
  double score_every_m = 50.0;
  double horizon_from_m = 140.0;
  double horizon_to_m = 600.0;
  double horizon_every_m = 20.0;
  int horizon_points = 80;
  double horizon_amplitude_m = 3.5;
  double horizon_wavelength_m = 20.0;
  double drivable_wavelength_m = 120.0;  ///< same amplitude: a bend of 100 m radius at most
  double history_m = 100.0;              ///< length of the measurements that KF and GP use
  double kalman_sigma = 0.06;            ///< KF: noise of a measurement

  /// Throws InvalidOption.
  void check() const;
  /// Throws BadInput.
  static SpmExperimentOptions load(const std::filesystem::path& file);
};

}  // namespace roadbook
