#pragma once

#include <string>
#include <vector>

#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

/// The shortest manoeuvre that, driven beside the drive at hand, would tell the accepted cause `a`
/// from all of `alternatives` (the losses of log likelihood that each would then have, at the size
/// found, reach twice the `threshold` in nats below which causes count as inseparable), as a
/// sentence; or that none tried does. Columns of the manoeuvre are those of the same candidates
/// about its own trajectory, with the drive's noise and the other accepted causes free.
[[nodiscard]] std::string separating_drive(const Observations& obs,
                                           const MotionModel& model,
                                           std::size_t a,
                                           const std::vector<Candidate>& alternatives,
                                           double threshold);

}  // namespace roadbook
