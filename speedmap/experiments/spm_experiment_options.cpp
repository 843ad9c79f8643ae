#include "speedmap/experiments/spm_experiment_options.hpp"

#include "base/error.hpp"
#include "base/yaml.hpp"

namespace roadbook {
namespace {

constexpr double kLarge = 1e6;
const Range kPositive{1e-6, kLarge};
const Range kNotNegative{0.0, kLarge};
const Range kShare{0.0, 0.999};

void require_experiment(bool good, const char* field, const std::string& got, const char* want) {
  if (!good) throw InvalidOption(field, got, want);
}

void read_ground(YamlMap& yaml, SpmExperimentOptions& o) {
  yaml.read("gravel_from_m", o.gravel_from_m, kPositive);
  yaml.read("gravel_wander_m", o.gravel_wander_m, kNotNegative);
  yaml.read("gravel_wander_length_m", o.gravel_wander_length_m, kPositive);
  yaml.read("wet_level", o.wet_level, Range{-10.0, 10.0});
  yaml.read("wet_length_s_m", o.wet_length_s_m, kPositive);
  yaml.read("wet_length_e_m", o.wet_length_e_m, kPositive);
  yaml.read_list("friction", 3, o.friction);
  yaml.read_list("friction_sigma", 3, o.friction_sigma);
  yaml.read("friction_spread", o.friction_spread, kShare);
  yaml.read("true_lambda", o.true_lambda, kPositive);
  yaml.read("true_alpha", o.true_alpha, Range{1.01, kLarge});
  yaml.read("true_purity", o.true_purity, kNotNegative);
}

void read_road(YamlMap& yaml, SpmExperimentOptions& o) {
  yaml.read("length_m", o.length_m, Range{100.0, kLarge});
  yaml.read("heading_amplitude_rad", o.heading_amplitude_rad);
  yaml.read("heading_wavelength_m", o.heading_wavelength_m);
  yaml.read("segments", o.segments, Range{1, 10000});
  yaml.read("degree", o.degree, Range{3, 9});
  yaml.read("half_width_m", o.half_width_m, kPositive);
  yaml.read("spacing_m", o.spacing_m, kPositive);
  yaml.read("kernel_width_m", o.kernel_width_m, kPositive);
}

void read_drive(YamlMap& yaml, SpmExperimentOptions& o) {
  yaml.read("speed_mps", o.speed_mps, kPositive);
  yaml.read("semantics_hz", o.semantics_hz, kPositive);
  yaml.read("friction_hz", o.friction_hz, kPositive);
  yaml.read("weave_amplitude_m", o.weave_amplitude_m);
  yaml.read("weave_wavelength_m", o.weave_wavelength_m);
  yaml.read("weave_phase_rad", o.weave_phase_rad);
  yaml.read("image_width", o.image_width, Range{16, 100000});
  yaml.read("image_height", o.image_height, Range{16, 100000});
  yaml.read("focal_px", o.focal_px, kPositive);
  yaml.read("camera_height_m", o.camera_height_m, kPositive);
  yaml.read("camera_pitch_rad", o.camera_pitch_rad, Range{-1.5, 1.5});
  yaml.read("range_min_m", o.range_min_m, kPositive);
  yaml.read("range_max_m", o.range_max_m, kPositive);
  yaml.read("pixel_spacing_m", o.pixel_spacing_m, kPositive);
}

void read_prior_and_score(YamlMap& yaml, SpmExperimentOptions& o) {
  yaml.read_list("prior_counts", 3, o.prior_counts);
  yaml.read("prior_error", o.prior_error, kShare);
  yaml.read("score_until_m", o.score_until_m, kPositive);
  yaml.read("score_every_m", o.score_every_m, kPositive);
  yaml.read("horizon_from_m", o.horizon_from_m, kPositive);
  yaml.read("horizon_to_m", o.horizon_to_m, kPositive);
  yaml.read("horizon_every_m", o.horizon_every_m, kPositive);
  yaml.read("horizon_points", o.horizon_points, Range{1, 10000});
  yaml.read("horizon_amplitude_m", o.horizon_amplitude_m, kNotNegative);
  yaml.read("horizon_wavelength_m", o.horizon_wavelength_m, kPositive);
  yaml.read("drivable_wavelength_m", o.drivable_wavelength_m, kPositive);
  yaml.read("history_m", o.history_m, kPositive);
  yaml.read("kalman_sigma", o.kalman_sigma, kPositive);
}

}  // namespace

void SpmExperimentOptions::check() const {
  require_experiment(maps >= 1, "maps", std::to_string(maps), "1 or more");
  require_experiment(
      heading_amplitude_rad.size() == heading_wavelength_m.size(), "heading_wavelength_m",
      std::to_string(heading_wavelength_m.size()) + " numbers", "as many as heading_amplitude_rad");
  require_experiment(weave_amplitude_m.size() == weave_wavelength_m.size() &&
                         weave_amplitude_m.size() == weave_phase_rad.size(),
                     "weave_wavelength_m", std::to_string(weave_wavelength_m.size()) + " numbers",
                     "as many as weave_amplitude_m and weave_phase_rad");
  require_experiment(range_max_m > range_min_m, "range_max_m", std::to_string(range_max_m),
                     "more than range_min_m");
  require_experiment(horizon_to_m + horizon_points <= length_m && score_until_m <= length_m,
                     "length_m", std::to_string(length_m),
                     "a road that holds the horizons and what is scored");
  require_experiment(horizon_amplitude_m <= half_width_m, "horizon_amplitude_m",
                     std::to_string(horizon_amplitude_m), "at most half_width_m");
}

SpmExperimentOptions SpmExperimentOptions::load(const std::filesystem::path& file) {
  SpmExperimentOptions options;
  YamlMap yaml = YamlMap::load(file);
  yaml.read("seed", options.seed);
  yaml.read("maps", options.maps, Range{1, 10000});
  read_road(yaml, options);
  read_ground(yaml, options);
  read_drive(yaml, options);
  read_prior_and_score(yaml, options);
  yaml.finish();
  options.check();
  return options;
}

}  // namespace roadbook
