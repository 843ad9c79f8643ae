#pragma once

#include "diagnosis/inference/evidence.hpp"
#include "diagnosis/motion/motion_library.hpp"
#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

/// Of a drive: residuals of the smoothed trajectory, before and after a cause.
[[nodiscard]] EvidencePlot motion_evidence(const Observations& obs,
                                           const MotionModel& nominal,
                                           const MotionModel& extended,
                                           const Candidate& cause);

}  // namespace roadbook
