#pragma once

#include <string>
#include <vector>

#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

/// The shortest manoeuvre after which the drive could separate accepted effect `a` from all of
/// `alternatives`, as a sentence, or a sentence that none of the tried ones does. Criterion: each
/// alternative would then lose twice `threshold` [nats] of log likelihood at the estimated size.
/// Columns of the manoeuvre are those of the same candidates about its own trajectory, with the
/// drive's noise and the other accepted effects free.
[[nodiscard]] std::string separating_drive(const Observations& obs,
                                           const MotionModel& model,
                                           std::size_t a,
                                           const std::vector<Candidate>& alternatives,
                                           double threshold);

}  // namespace roadbook
