#pragma once

#include "mapping/cameras/camera_doubts.hpp"
#include "mapping/optimisation/cluster_options.hpp"
#include "mapping/pipeline/bundle_problem.hpp"

namespace roadbook {

/// What the doubts about cameras would do to the predicted pixels of an adjusted problem: one
/// common error for each parameter that a doubt names, of the size that it names. Where several
/// cameras are doubted, one more holds the likeliest parameters of all, as a wrong lens of all
/// cameras would be. Doubts without a parameter (repeated or exchanged images) give none.One more
/// for each session, in which its cameras do not contradict each other, so that no doubt need name
/// it: all focal lengths wrong by one factor, which counts if the residuals show it. One for all
/// sessions: the height by which corners lie above their objects, which always counts.
[[nodiscard]] std::vector<CommonError> common_errors_of(const std::vector<CameraDoubt>& doubts,
                                                        const MappingInput& input,
                                                        const BundleStage& stage);

}  // namespace roadbook
