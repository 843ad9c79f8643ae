#pragma once

#include "diagnosis/evidence.hpp"
#include "diagnosis/motion_library.hpp"
#include "diagnosis/motion_model.hpp"

namespace roadbook {

/// Of a drive: residuals of the smoothed trajectory, before and after a cause.
[[nodiscard]] EvidencePlot motion_evidence(const Observations& obs,
                                           const MotionModel& nominal,
                                           const MotionModel& extended,
                                           const Candidate& cause);

}  // namespace roadbook
