#pragma once

#include "diagnosis/motion/motion_model.hpp"
#include "diagnosis/motion/regularised_effects.hpp"

namespace roadbook {

// Readings with autocorrelated errors count as fewer independent ones: their noise grows by the
// factor by which the uncertainty of a slow mean grows.

/// True if the poses have autocorrelated errors, with the effects fitted.
[[nodiscard]] bool poses_correlate(const Observations& obs,
                                   MotionModel& model,
                                   const HeldEffects& s);

/// Increases the noise of poses whose innovations are autocorrelated.
void allow_for_correlated_poses(const Observations& obs, MotionModel& model, const HeldEffects& s);

/// Increases the noise of steering if neighbouring readings correlate significantly and the
/// innovations are autocorrelated. The simpler generic effects are fitted too, because a cause
/// without a catalogued effect may look like autocorrelation.
void allow_for_correlated_steering(const Observations& obs,
                                   MotionModel& model,
                                   const std::vector<Accepted>& places);

}  // namespace roadbook
