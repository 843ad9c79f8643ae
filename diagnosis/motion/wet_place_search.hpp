#pragma once

#include <vector>

#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

// Selects the places where the wheels may slip. A long drive has many candidates, and each would be
// a column of the elimination. A first pass over the nominal residuals selects a few of them, so
// that the cost stays linear in the length of the drive.

/// The `most` places with the largest approximate score statistic, in their original order. The
/// statistic uses the columns before projection: product of the column with the gradient of the
/// smoothed fit, squared, over the column's own square.
[[nodiscard]] std::vector<Candidate> shortlist_places(const Observations& obs,
                                                      const MotionModel& model,
                                                      const std::vector<Candidate>& places,
                                                      std::size_t most = 24);

/// Up to three places where the wheels slip so clearly that the noise must be estimated with them
/// in the model. Each is scored with the catalogued effects and the earlier places free. Empty if
/// there would be a fourth: many places mean an error along the whole way. The model's residual
/// must be that of its point.
[[nodiscard]] std::vector<Accepted> slipping_places(const Observations& obs,
                                                    const MotionModel& model);

}  // namespace roadbook
