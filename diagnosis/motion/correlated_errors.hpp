#pragma once

#include "diagnosis/motion/motion_model.hpp"
#include "diagnosis/motion/regularised_effects.hpp"

namespace roadbook {

// Readings whose errors go on for long are worth fewer independent ones: their noise grows by as
// much as a slow mean of theirs is more uncertain.

/// Whether poses have errors that go on, with the effects fitted.
[[nodiscard]] bool poses_correlate(const Observations& obs,
                                   MotionModel& model,
                                   const HeldEffects& s);

/// Grows the noise of poses whose innovations go on.
void allow_for_correlated_poses(const Observations& obs, MotionModel& model, const HeldEffects& s);

/// Grows the noise of steering whose neighbouring readings surely correlate and whose innovations
/// go on, with the plainer terms of the grammar fitted beside the names: what goes on may be a
/// cause that no name has.
void allow_for_correlated_steering(const Observations& obs,
                                   MotionModel& model,
                                   const std::vector<Accepted>& places);

}  // namespace roadbook
