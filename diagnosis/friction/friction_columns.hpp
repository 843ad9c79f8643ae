#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/friction/friction_readings.hpp"
#include "diagnosis/inference/candidate.hpp"

namespace roadbook {

// Candidates for friction readings as columns: derivatives of each reading by the size of an
// effect.

/// The surface classes that occur, ascending, and for each reading the index of its class.
struct SurfaceClasses {
  std::vector<int> labels;
  std::vector<std::size_t> of;
};
[[nodiscard]] SurfaceClasses surface_classes(const std::vector<FrictionSample>& samples);

/// The catalogued effects that act on all readings ("friction0.slip_bias" ...). Effects of a column
/// that the recording lacks are left out.
[[nodiscard]] std::vector<Candidate> friction_effects(const FrictionReadings& readings);
/// Generic effects: a bias of all readings, or of those on wet ground, as a smooth function of
/// speed, acceleration and other covariates.
[[nodiscard]] std::vector<Candidate> friction_grammar(const FrictionReadings& readings,
                                                      const SurfaceClasses& classes);
/// Subtracts the given effects from each reading.
void take_off_friction(const EffectSizes& sizes, FrictionReadings& readings);
/// The columns of a candidate, one row a reading. Generic effects have polynomials of the
/// covariate, scaled to unit variance; 0 if it does not vary.
[[nodiscard]] Eigen::MatrixXd friction_columns(const FrictionReadings& readings,
                                               const SurfaceClasses& classes,
                                               const Candidate& candidate);

/// True for the built-in covariates: "speed", ..., "friction in use", "temperature".
[[nodiscard]] bool is_friction_covariate(std::string_view name);
/// Values of a covariate ("speed", "time" ...) at all readings.
[[nodiscard]] Eigen::VectorXd friction_covariate(const std::vector<FrictionSample>& samples,
                                                 const std::string& name);

}  // namespace roadbook
