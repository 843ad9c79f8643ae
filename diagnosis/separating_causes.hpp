#pragma once

#include "diagnosis/diagnose.hpp"

namespace roadbook {

/// Names the drive that would tell apart what stands in one set, for causes that another kind of
/// data than motion has found (views in a map) and that have none yet: the first manoeuvre that
/// does it beside the motion of this drive (`separating_drive`), of effects that motion shows.
/// Where it shows not all of them: in what such a drive has to vary, by the covariates declared of
/// the effects. `streams`: of this drive; `options` those of its diagnosis.
void name_separating_drives(const MotionStreams& streams,
                            const DiagnosisOptions& options,
                            Diagnosis& d);

}  // namespace roadbook
