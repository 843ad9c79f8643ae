#pragma once

#include "mapping/cameras/camera_doubts.hpp"
#include "mapping/optimisation/cluster_options.hpp"
#include "mapping/pipeline/bundle_problem.hpp"

namespace roadbook {

/// What the doubts about cameras would do to the predicted pixels of an adjusted problem: one
/// common error for each parameter that a doubt names, of the size that it names. Where several
/// cameras are doubted, one more holds the likeliest parameters of all, as a wrong lens of all
/// cameras would be. Doubts without a parameter (repeated or exchanged images) give none. Two more
/// need no doubt, because the cameras do not contradict each other: the focal lengths of all
/// cameras wrong by one factor, for each calibration that sessions have, which counts if the
/// residuals show it; and the height by which corners lie above their objects, for all sessions,
/// which always counts.
[[nodiscard]] std::vector<CommonError> common_errors_of(const std::vector<CameraDoubt>& doubts,
                                                        const MappingInput& input,
                                                        const BundleStage& stage);

}  // namespace roadbook
