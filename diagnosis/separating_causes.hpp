#pragma once

#include "diagnosis/diagnose.hpp"

namespace roadbook {

/// Adds to each confounded set the drive that would separate it, for effects found in other data
/// than motion (camera observations) that have none yet. The first manoeuvre that separates the set
/// in addition to the motion of this drive is taken (`separating_drive`), for effects that motion
/// shows. For other effects the covariates that such a drive must vary are named. `streams`: of
/// this drive; `options`: of its diagnosis.
void name_separating_drives(const MotionStreams& streams,
                            const DiagnosisOptions& options,
                            Diagnosis& d);

}  // namespace roadbook
