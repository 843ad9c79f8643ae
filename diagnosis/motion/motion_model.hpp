#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/motion/motion_fit.hpp"
#include "diagnosis/motion/motion_library.hpp"

namespace roadbook {

/// A trajectory fitted to a drive, and the noise it was fitted with.
struct FittedMotion : CauseState {
  MotionEffects known;  ///< part of the nominal model
  MotionPoint point;
  MotionNoise noise;
  std::vector<double> inflation;  ///< of each row's sigma: outliers
};

/// The nominal model extended by accepted causes, fitted to a drive.
struct MotionModel : FittedMotion {
  std::vector<Accepted> accepted;
  // Of the last fit:
  Eigen::MatrixXd information;  ///< of all accepted sizes, in order; trajectory projected out
  double log_likelihood = 0.0;  ///< but for constants
};

/// The named candidate's size among the effects.
[[nodiscard]] double& size_of(MotionEffects& effects, const Candidate& named);

/// Columns of all accepted causes at the model's point.
[[nodiscard]] Columns accepted_columns(const Observations& obs, const MotionModel& model);

/// Residuals at the model's point, with terms of the grammar and places taken off.
void renew_residual(const Observations& obs, MotionModel& model);

/// Gauss-Newton over trajectory and accepted sizes until both converge, with fixed noise. `others`:
/// information of other drives about the sizes. Discs take more iterations than `iterations`,
/// unless that is one.
void fit_model(const Observations& obs,
               MotionModel& model,
               int iterations = 3,
               const SizePrior& others = {});

/// Nominal trajectory and noise: noise is estimated with every named effect free (held by its
/// plausible size), or it would swallow the causes; then loosened and the nominal model fitted.
/// `known`: sizes of effects that are part of the model already.
[[nodiscard]] MotionModel nominal_model(Observations& obs, const EffectSizes& known = {});

}  // namespace roadbook
