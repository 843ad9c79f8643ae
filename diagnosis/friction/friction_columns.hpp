#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/friction/friction_readings.hpp"
#include "diagnosis/inference/candidate.hpp"

namespace roadbook {

// What might be wrong with friction readings, as columns: changes of each reading by a size of 1.

/// Classes that occur, ascending, and each reading's index among them.
struct SurfaceClasses {
  std::vector<int> labels;
  std::vector<std::size_t> of;
};
[[nodiscard]] SurfaceClasses surface_classes(const std::vector<FrictionSample>& samples);

/// Named effects that act on all readings ("friction0.slip_bias", ...); those of columns that the
/// recording lacks are left out.
[[nodiscard]] std::vector<Candidate> friction_effects(const FrictionReadings& readings);
/// Bias, of all or of wet ground, times speed, acceleration, ... as smooth functions.
[[nodiscard]] std::vector<Candidate> friction_grammar(const FrictionReadings& readings,
                                                      const SurfaceClasses& classes);
/// Takes off each reading what these sizes of those effects change of it.
void take_off_friction(const EffectSizes& sizes, FrictionReadings& readings);
/// One column a term. Terms of the grammar are polynomials of the covariate, scaled to unit
/// variance; zero where it does not vary.
[[nodiscard]] Eigen::MatrixXd friction_columns(const FrictionReadings& readings,
                                               const SurfaceClasses& classes,
                                               const Candidate& candidate);

/// The grammar's own names of covariates: "speed", ..., "friction in use", "temperature".
[[nodiscard]] bool is_friction_covariate(std::string_view name);
/// Values of a covariate ("speed", "time", ...) at all readings.
[[nodiscard]] Eigen::VectorXd friction_covariate(const std::vector<FrictionSample>& samples,
                                                 const std::string& name);

}  // namespace roadbook
